"""Judges one replay with a falsified machine or map against the truth, and sums up many of them.

Whether a frame is wrong comes from truth.csv; when the fault has to be noticed from the motion of the true joints, a
plc.csv that nobody falsified. Metres, seconds, degrees.
"""
import dataclasses
import math

import numpy as np

import attack_faults as faults
import campaign_judge as judge

UNSEEN = (0.05, 0.15)      # m, deg: a pose that is off by less may stay unseen for good
NOTICE_S = 3.0             # from the motion that shows a fault to health 0
MAX_SPEED = 0.3            # m/s, hull.max_speed
SPEEDING_S = 0.5           # that long has the hull to seem faster than that
ACCUSED, IMPLAUSIBLE = 4, 1024  # fault bits 2 and 10
WORDS = {"travel": ("travel", "gantry"), "slew": ("slew",), "luff": ("luff",)}


# What wear within its class hides of a joint where a map of the quay is in view (table of ICD 3.1): at d_x = 0, and
# for each metre of travel.
HIDDEN = {"travel": (0.13, 0.05 / 30), "slew": (0.4, 0.0), "luff": (0.8, 0.0)}  # m, deg
IN_VIEW = 1.5  # the quay is in view where it hides no more than so many times that


def at_times(plc, column, t_ns):
    return np.interp(t_ns - plc["t_ns"][0], plc["t_ns"] - plc["t_ns"][0], plc[column])


def bridged(condition, t_ns, seconds=1.0):
    """`condition`, and breaks in it that are shorter than that: a frame without joints, a lorry that drives by."""
    whole = condition.copy()
    for begin in np.flatnonzero(condition[:-1] & ~condition[1:]):
        ahead = np.flatnonzero(condition[begin + 1:])
        if len(ahead) and t_ns[begin + 1 + ahead[0]] - t_ns[begin] < seconds * faults.SECOND:
            whole[begin:begin + 1 + ahead[0]] = True
    return whole


def until(shown_, cleared):
    """Once shown it stays so until it is cleared."""
    stands, result = False, np.zeros(len(shown_), dtype=bool)
    for i in range(len(shown_)):
        stands = bool(shown_[i]) or (stands and not cleared[i])
        result[i] = stands
    return result


def lasting(condition, t_ns, seconds):
    """Where `condition` has been true for that long without a break."""
    last_false = np.maximum.accumulate(np.where(condition, -1, np.arange(len(condition))))
    return condition & (t_ns - t_ns[np.maximum(last_false, 0)] >= seconds * faults.SECOND)


@dataclasses.dataclass
class View:
    """What the quay shows of an honest machine: from `hulltrack replay --joints`."""
    t_ns: np.ndarray
    hidden: dict  # by joint: m, deg; infinite where the scan does not tell

    def hides(self, joint, t_ns):
        """In the frames of t_ns, which are the honest machine's or fewer."""
        return self.hidden[joint][np.minimum(np.searchsorted(self.t_ns, t_ns), len(self.t_ns) - 1)]


def view(table):
    """Of a table of judge.read_table()."""
    return View(table["t_ns"], {joint: np.where(np.isnan(table[f"{joint}_hidden"]), np.inf, table[f"{joint}_hidden"])
                                for joint in faults.JOINTS})


def by_the_table(joint, plc, t_ns):
    amount, for_each_metre = HIDDEN[joint]
    return amount + for_each_metre * np.abs(at_times(plc, "d_x", t_ns))


def in_view(seen, joint, plc, t_ns):
    return seen.hides(joint, t_ns) <= IN_VIEW * by_the_table(joint, plc, t_ns)


def off_by(plc, falsified, joint, t_ns):
    column = faults.JOINTS[joint]
    return np.abs(at_times(falsified, column, t_ns) - at_times(plc, column, t_ns))


def owed_by_amount(plc, falsified, begin, seen, t_ns):
    """At which of the times t_ns one of the joints has been off for long enough by more than wear hides where the quay
    shows it, and has not been seen right since."""
    result = np.zeros(len(t_ns), dtype=bool)
    for joint in faults.JOINTS:
        off, in_view_ = off_by(plc, falsified, joint, t_ns), in_view(seen, joint, plc, t_ns)
        hidden = np.maximum(seen.hides(joint, t_ns), by_the_table(joint, plc, t_ns))
        shown_ = (off > hidden) & in_view_ & (t_ns >= begin)
        result |= until(lasting(bridged(shown_, t_ns), t_ns, NOTICE_S), in_view_ & (off <= hidden))
    return result


def beyond_the_table(attack, plc, falsified, begin, t_ns):
    """At which of the times t_ns a joint is off by more than the table says, whether the quay shows it or not."""
    beyond = np.zeros(len(t_ns), dtype=bool)
    for joint in attack.joints:
        beyond |= (off_by(plc, falsified, joint, t_ns) > by_the_table(joint, plc, t_ns)) & (t_ns >= begin)
    return lasting(beyond, t_ns, NOTICE_S)


def shown_by_motion(plc, joints, begin):
    """ns at which one of the joints has moved far enough since `begin`; None = not in this run."""
    moments = []
    for joint in joints:
        after = plc["t_ns"] >= begin
        v = plc[faults.JOINTS[joint]][after]
        travelled = np.maximum.accumulate(v) - np.minimum.accumulate(v) if len(v) else v
        far = np.flatnonzero(travelled >= faults.SHOWING_MOTION[joint])
        if len(far):
            moments.append(plc["t_ns"][after][far[0]])
    return min(moments, default=None)


def lever(plc, joint, machine, point):
    """Distance of `point` (x, y, z in W) from the joint's axis, a row each, m; `machine`: as in the configuration."""
    slew, luff = (np.array(machine[name]["xyz"]) for name in ("slew", "luff"))
    from_slew = np.array(point) - slew - np.outer(plc["d_x"], [1, 0, 0])
    if joint == "slew":
        return np.hypot(from_slew[:, 0], from_slew[:, 1])
    c, s = np.cos(np.radians(plc["theta_r"])), np.sin(np.radians(plc["theta_r"]))
    ahead = from_slew[:, 0] * c + from_slew[:, 1] * s - luff[0]  # in the boom's vertical plane
    return np.hypot(ahead, from_slew[:, 2] - luff[2])


def apparent_speed(plc, joint, machine, point):
    """How fast a hull that lies still seems to move at `point` when the joint's value stands still, m/s."""
    seconds = (plc["t_ns"] - plc["t_ns"][0]) * 1e-9
    v = plc[faults.JOINTS[joint]]
    half = 0.25  # s; encoders have steps
    rate = np.abs(np.interp(seconds + half, seconds, v) - np.interp(seconds - half, seconds, v)) / (2 * half)
    return rate if joint == "travel" else np.radians(rate) * lever(plc, joint, machine, point)


def shown_by_speed(plc, joints, begin, machine, point):
    """ns at which the hull has seemed too fast for long enough; None = not in this run."""
    moments = []
    for joint in joints:
        too_fast = (apparent_speed(plc, joint, machine, point) > MAX_SPEED) & (plc["t_ns"] >= begin)
        far = np.flatnonzero(lasting(too_fast, plc["t_ns"], SPEEDING_S))
        if len(far):
            moments.append(plc["t_ns"][far[0]])
    return min(moments, default=None)


def owed(attack, plc, falsified, begin, seen, machine, point, t_ns):
    """At which of the times t_ns the fault has shown for long enough: health 0, or the pose right. `plc` is the true
    one, `seen` the View of the quay's map or None without one."""
    def since(moment):
        return np.zeros(len(t_ns), dtype=bool) if moment is None else t_ns > moment + NOTICE_S * faults.SECOND

    way = "shown" if seen else attack.without
    if way == "never" or (attack.within_class and attack.name != "honest"):
        return since(None)
    if not attack.joints and attack.without == "shown":
        return since(begin)
    if not attack.joints:
        every = np.all([in_view(seen, joint, plc, t_ns) for joint in faults.JOINTS], axis=0)
        return lasting(bridged(every & (t_ns >= begin), t_ns), t_ns, NOTICE_S)
    if seen:
        return owed_by_amount(plc, falsified, begin, seen, t_ns)
    return since(shown_by_motion(plc, attack.joints, begin) if way == "shown" else
                 shown_by_speed(plc, attack.joints, begin, machine, point))


@dataclasses.dataclass
class Verdict:
    """One replay of an attack, from the fault's beginning on."""
    frames: int
    healthy: int
    wrong: int           # healthy, and off by more than 5 cm or 0.1 deg
    grave: int           # healthy, and off by more than may stay unseen
    late: int            # of these when the fault has shown for 3 s
    owed: int            # frames in which it had shown for 3 s, healthy or not
    beyond: int          # frames in which a joint had been off by more than the table's amount for 3 s, in view or not
    worst_m: float       # of healthy frames
    worst_deg: float
    shows_s: float       # from the beginning to when it first shows for 3 s; inf = nothing need ever tell
    fell_s: float        # from the beginning to health 0 after a 1; 0 = it was never 1; inf = it stayed 1
    until_s: float       # from the beginning to the last grave frame; None = there is none
    charged: int         # frames in which the machine was accused
    bit: bool            # was bit 2 or 10 set while health was 0?
    named: bool          # was the joint named then? None without a joint, or without reasons in the table
    refused: bool = False


REFUSED = Verdict(frames=0, healthy=0, wrong=0, grave=0, late=0, owed=0, beyond=0, worst_m=0.0, worst_deg=0.0,
                  shows_s=math.inf, fell_s=0.0, until_s=None, charged=0, bit=False, named=None, refused=True)


def names_joint(frames, down, joints):
    if "reason" not in frames or not joints:
        return None
    text = " ".join(frames["reason"][down]).lower()
    return any(word in text for joint in joints for word in WORDS[joint])


def fall(frames, after, seconds):
    """When health went from 1 to 0 in the frames `after` the beginning."""
    healthy = frames["health"] == 1
    ones = np.flatnonzero(healthy & after)
    if np.any(healthy[~after][-1:]):
        ones = np.append(np.flatnonzero(after)[:1], ones)
    if not len(ones):
        return 0.0
    zeros = np.flatnonzero(after & ~healthy)
    zeros = zeros[zeros >= ones[0]]
    return seconds(frames["t_ns"][zeros[0]]) if len(zeros) else math.inf


def judge_attack(frames, truth, begin, owed_, joints=(), unseen=UNSEEN, beyond=0):
    """`begin`: ns; `owed_`: of each frame, as owed() says; `beyond`: a number of frames. Tables of
    judge.read_table()."""
    twists = judge.error_twists(frames, truth)
    error = np.linalg.norm(twists[:, 3:], axis=1)
    turn = np.degrees(np.linalg.norm(twists[:, :3], axis=1))
    after = frames["t_ns"] >= begin
    healthy = after & (frames["health"] == 1)
    wrong = healthy & ~judge.within(error, turn)
    grave = healthy & ~((error <= unseen[0]) & (turn <= unseen[1]))
    late = grave & owed_
    down = after & (frames["health"] != 1)
    bits = frames["faults"].astype(int)

    def largest(values):
        return float(np.max(np.nan_to_num(values[healthy], nan=math.inf))) if healthy.any() else 0.0

    def since_begin(t_ns):
        return float(t_ns - begin) * 1e-9

    return Verdict(frames=int(after.sum()), healthy=int(healthy.sum()), wrong=int(wrong.sum()), grave=int(grave.sum()),
                   late=int(late.sum()), owed=int(np.count_nonzero(owed_)), beyond=int(beyond),
                   worst_m=largest(error), worst_deg=largest(turn),
                   shows_s=since_begin(frames["t_ns"][owed_][0]) - NOTICE_S if owed_.any() else math.inf,
                   fell_s=fall(frames, after, since_begin),
                   until_s=since_begin(frames["t_ns"][grave][-1]) if grave.any() else None,
                   charged=int(np.count_nonzero(bits[after] & ACCUSED)),
                   bit=bool(np.any(bits[down] & (ACCUSED | IMPLAUSIBLE))), named=names_joint(frames, down, joints))


def told(verdicts, what):
    """In how many of the runs, as text."""
    known = [getattr(v, what) for v in verdicts if getattr(v, what) is not None and not v.refused]
    return f"{sum(known)}/{len(known)}" if known else "-"


def summary(verdicts):
    """The figures of all runs of an attack by column of the table."""
    def total(name):
        return sum(getattr(v, name) for v in verdicts)

    def most(name):
        return max((getattr(v, name) for v in verdicts if getattr(v, name) is not None), default=None)

    return {"runs": len(verdicts), "refused": total("refused"), "frames": total("frames"), "healthy": total("healthy"),
            "wrong": total("wrong"), "grave": total("grave"), "late": total("late"), "owed": total("owed"),
            "worst_m": most("worst_m"),
            "worst_deg": most("worst_deg"), "fell_s": most("fell_s"), "until_s": most("until_s"),
            "charged": total("charged"), "bit": told(verdicts, "bit"), "named": told(verdicts, "named")}
