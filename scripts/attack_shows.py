"""When a fault of the machine has shown, by the table of ICD 3.1: what a map of the quay, bounds, speed and moves tell.

From the true joints and the falsified ones, the ship's own motion, what the map shows of an honest machine, and which
frames were healthy. Metres, seconds, degrees, unless a name says otherwise.
"""
import dataclasses

import numpy as np

import attack_faults as faults

NOTICE_S = 3.0             # from what shows a fault to health 0

# What wear within its class hides of a joint where a map of the quay is in view (table of ICD 3.1): at d_x = 0, and
# for each metre of travel.
HIDDEN = {"travel": (0.13, 0.05 / 30), "slew": (0.4, 0.0), "luff": (0.8, 0.0)}  # m, deg
IN_VIEW = 1.5  # the quay is in view where it hides no more than so many times that
# More than that may put the quay farther off than its planes are looked for, 0.6 m: of the angles at 60 and 40 m.
SMALL = {"travel": 0.5, "slew": 0.5, "luff": 0.9}  # m, deg


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
    far: dict     # by joint: whether a large error would be found

    def at(self, t_ns):
        """Which of its frames those of t_ns are, which are the honest machine's or fewer."""
        return np.minimum(np.searchsorted(self.t_ns, t_ns), len(self.t_ns) - 1)

    def hides(self, joint, t_ns):
        return self.hidden[joint][self.at(t_ns)]

    def finds_large(self, joint, t_ns):
        return self.far[joint][self.at(t_ns)]


def view(table):
    """Of a table of judge.read_table()."""
    def mostly(flags):
        """In nine in ten of the frames of a second."""
        return np.convolve(flags, np.ones(11), "same") >= 0.9 * np.convolve(np.ones(len(flags)), np.ones(11), "same")

    return View(table["t_ns"],
                {joint: np.where(np.isnan(table[f"{joint}_hidden"]), np.inf, table[f"{joint}_hidden"])
                 for joint in faults.JOINTS}, {joint: mostly(table[f"{joint}_far"]) for joint in faults.JOINTS})


def by_the_table(joint, plc, t_ns):
    amount, for_each_metre = HIDDEN[joint]
    return amount + for_each_metre * np.abs(at_times(plc, "d_x", t_ns))


def in_view(seen, joint, plc, t_ns, off=np.inf):
    """At which of the times t_ns an error of the joint of `off` is."""
    return (seen.hides(joint, t_ns) <= IN_VIEW * by_the_table(joint, plc, t_ns)) & (
        seen.finds_large(joint, t_ns) | (off <= SMALL[joint]))


def off_by(plc, falsified, joint, t_ns):
    column = faults.JOINTS[joint]
    return np.abs(at_times(falsified, column, t_ns) - at_times(plc, column, t_ns))


def owed_by_amount(plc, falsified, begin, seen, t_ns):
    """At which of the times t_ns one of the joints has been off for long enough by more than wear hides where the quay
    shows it, and has not been seen right since."""
    result = np.zeros(len(t_ns), dtype=bool)
    for joint in faults.JOINTS:
        off = off_by(plc, falsified, joint, t_ns)
        in_view_ = in_view(seen, joint, plc, t_ns, off)
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


# Without a map. Farther off than this the hull lies as she cannot: hull.max_yaw; max_heel and max_trim at the worst
# slew, deg.
LARGEST = {"slew": 3.5, "luff": 4.5}
MAX_SPEED = 0.3  # m/s, hull.max_speed
RUN_M = 1.0      # so far has the hull to seem to run faster than that without a pause

# A move of the machine, from rest to rest: slower than this a joint stands, m/s and deg/s; it has to travel so far,
# m and deg; and how the hull lies is asked so long after it, and after so long at most.
STANDS = {"travel": 0.03, "slew": 0.08, "luff": 0.08}
SHORTEST = {"travel": 0.5, "slew": 2.0, "luff": 1.0}
SETTLES_S, LONGEST_S = 0.3, 10.0
FEWEST_MOVES = 4
# What a hull does by herself meanwhile: rotation, then translation, rad and m. So many moves are what that is worth
# when her motion in this run is reckoned with, and a mean of moves so many standard errors off nothing is not hers.
OWN_MOTION = np.array([*np.radians([0.3, 0.1, 0.1]), 0.15, 0.10, 0.05])
PRIOR_MOVES = 10.0
ERRORS_OFF = 9.0
LEAST_SCALE = 0.02


def own_lie(truth, joint, t_ns):
    """How far the hull lies turned as an error of the joint would turn her, deg."""
    of = {name: at_times(truth, name, t_ns) for name in ("roll", "pitch", "yaw")}
    return np.abs(of["yaw"]) if joint == "slew" else np.hypot(of["roll"], of["pitch"])


def owed_by_bounds(plc, falsified, truth, t_ns):
    """At which of the times t_ns the hull has seemed to lie as she cannot for long enough."""
    result = np.zeros(len(t_ns), dtype=bool)
    for joint, bound in LARGEST.items():
        result |= lasting(off_by(plc, falsified, joint, t_ns) > bound + own_lie(truth, joint, t_ns), t_ns, NOTICE_S)
    return result


def lever(plc, joint, machine, point):
    """Distance of `point` (x, y, z in W) from the joint's axis, a row each, m; `machine`: as in the configuration."""
    slew, luff = (np.array(machine[name]["xyz"]) for name in ("slew", "luff"))
    from_slew = np.array(point) - slew - np.outer(plc["d_x"], [1, 0, 0])
    if joint == "slew":
        return np.hypot(from_slew[:, 0], from_slew[:, 1])
    c, s = np.cos(np.radians(plc["theta_r"])), np.sin(np.radians(plc["theta_r"]))
    ahead = from_slew[:, 0] * c + from_slew[:, 1] * s - luff[0]  # in the boom's vertical plane
    return np.hypot(ahead, from_slew[:, 2] - luff[2])


def apparent_speed(plc, falsified, joint, machine, point):
    """How fast a hull that lies still seems to move at `point` by the error of the joint, m/s."""
    seconds = (plc["t_ns"] - plc["t_ns"][0]) * 1e-9
    error = plc[faults.JOINTS[joint]] - at_times(falsified, faults.JOINTS[joint], plc["t_ns"])
    half = 0.25  # s; encoders have steps
    rate = np.abs(np.interp(seconds + half, seconds, error) - np.interp(seconds - half, seconds, error)) / (2 * half)
    return rate if joint == "travel" else np.radians(rate) * lever(plc, joint, machine, point)


def shown_by_speed(plc, falsified, truth, begin, machine, point):
    """ns at which the hull has seemed to run too fast for far enough, whatever way she runs herself; None = not in this
    run."""
    moments = []
    own = np.linalg.norm([np.gradient(at_times(truth, name, plc["t_ns"]), (plc["t_ns"] - plc["t_ns"][0]) * 1e-9)
                          for name in "xyz"], axis=0)
    dt = np.diff(plc["t_ns"], append=plc["t_ns"][-1]) * 1e-9
    for joint in faults.JOINTS:
        speed = apparent_speed(plc, falsified, joint, machine, point)
        too_fast = (speed - own > MAX_SPEED) & (plc["t_ns"] >= begin)
        way = np.cumsum(np.where(too_fast, (speed - own) * dt, 0.0))
        way -= np.maximum.accumulate(np.where(too_fast, 0.0, way))
        far = np.flatnonzero(way > RUN_M)
        if len(far):
            moments.append(plc["t_ns"][far[0]])
    return min(moments, default=None)


def moves(falsified, t_ns):
    """First and last of the times t_ns of each move of the machine that was seen whole."""
    seconds = (t_ns - t_ns[0]) * 1e-9
    at = {joint: at_times(falsified, column, t_ns) for joint, column in faults.JOINTS.items()}
    moving = np.any([np.abs(np.diff(at[joint])) > STANDS[joint] * np.diff(seconds) for joint in faults.JOINTS], axis=0)
    begin = last = None
    for i in range(1, len(t_ns)):
        if moving[i - 1]:
            begin, last = (i - 1 if begin is None else begin), i
        if begin is not None and (seconds[i] - seconds[last] >= SETTLES_S or seconds[i] - seconds[begin] >= LONGEST_S):
            yield begin, i
            begin = None


def columns_of(falsified, first, last, machine, point):
    """By which twist (rad, m) the hull seems to move at `point` when a joint is all of it wrong from first to last
    (ns): a column a joint."""
    steps = np.linspace(first, last, 50).astype(np.int64)
    at = {joint: at_times(falsified, column, steps) for joint, column in faults.JOINTS.items()}
    slew_axis, luff_axis = (np.array(machine[name]["xyz"]) for name in ("slew", "luff"))
    columns = np.zeros((6, 3))
    for i in range(1, len(steps)):
        c, s = np.cos(np.radians(at["slew"][i])), np.sin(np.radians(at["slew"][i]))
        turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        slew = slew_axis + [at["travel"][i], 0, 0]
        about = {"slew": (np.array([0.0, 0.0, 1.0]), slew),
                 "luff": (turned @ [0, 1, 0], slew + turned @ luff_axis)}
        step = {joint: at[joint][i] - at[joint][i - 1] for joint in at}
        columns[3, 0] += step["travel"]
        for j, (joint, (axis, through)) in enumerate(about.items(), start=1):
            columns[:, j] += np.radians(step[joint]) * np.concatenate([axis, np.cross(axis, point - through)])
    return columns


def own_motion(truth, first, last):
    """What the hull did by herself from first to last (ns), as a twist of small angles (rad, m)."""
    def moved(name):
        return float(np.diff(at_times(truth, name, np.array([first, last])))[0])

    return np.array([np.radians(moved(name)) for name in ("roll", "pitch", "yaw")] + [moved(n) for n in "xyz"])


def beyond_chance(scales, worths, forward):
    """Have these moves shown that the hull moves with the joint?"""
    if len(scales) < FEWEST_MOVES or all(forward) or not any(forward):
        return False
    s, w = np.array(scales), np.array(worths)
    mean = np.sum(w * s) / np.sum(w)
    scatter = PRIOR_MOVES + np.sum(w * (s - mean) ** 2)
    error = np.sqrt(scatter / (PRIOR_MOVES + len(s) - 1) / np.sum(w))
    return abs(mean) > LEAST_SCALE and abs(mean) > ERRORS_OFF * error


def shown_by_moves(plc, falsified, truth, begin, machine, point, t_ns, seen_whole):
    """ns at which the hull has moved with a joint often enough; None = not in this run. `seen_whole`: by t_ns, whether
    the hull was seen then."""
    told = {joint: ([], [], []) for joint in faults.JOINTS}
    for first, last in moves(falsified, t_ns):
        if t_ns[first] < begin or not seen_whole[first:last + 1].all():
            continue
        ends = t_ns[[first, last]]
        X = columns_of(falsified, *ends, machine, np.array(point)) / OWN_MOTION[:, None]
        reads = np.array([np.diff(at_times(falsified, c, ends))[0] for c in faults.JOINTS.values()])
        goes = np.array([np.diff(at_times(plc, c, ends))[0] for c in faults.JOINTS.values()])
        share = np.divide(reads - goes, reads, out=np.zeros(3), where=reads != 0)
        covariance = np.linalg.inv(X.T @ X + np.eye(3))
        scales = covariance @ X.T @ (X @ share + own_motion(truth, *ends) / OWN_MOTION)
        for j, joint in enumerate(faults.JOINTS):
            if abs(reads[j]) < SHORTEST[joint]:
                continue
            for into, value in zip(told[joint], (scales[j], 1.0 / covariance[j, j], reads[j] > 0)):
                into.append(value)
            if beyond_chance(*told[joint]):
                return t_ns[last]
    return None


def every_joint_in_view(seen, plc, t_ns):
    return np.all([in_view(seen, joint, plc, t_ns) for joint in faults.JOINTS], axis=0)


def owed(attack, plc, falsified, truth, begin, seen, machine, point, frames):
    """In which of the frames the fault has shown for long enough: health 0, or the pose right. `plc` is the true one,
    `seen` the View of the quay's map or None without one."""
    t_ns = frames["t_ns"]

    def since(moment):
        return np.zeros(len(t_ns), dtype=bool) if moment is None else t_ns > moment + NOTICE_S * faults.SECOND

    if attack.at_once:
        return since(begin)
    if attack.within_class:
        return since(None)
    if not attack.joints:
        if not seen:
            return since(None)
        every = every_joint_in_view(seen, plc, t_ns) & (t_ns >= begin)
        return lasting(bridged(every, t_ns), t_ns, NOTICE_S)
    result = owed_by_bounds(plc, falsified, truth, t_ns) & (t_ns >= begin)
    result |= since(shown_by_speed(plc, falsified, truth, begin, machine, point))
    # While a map confirms all joints moves are not asked.
    asked = (frames["health"] == 1) & ~(every_joint_in_view(seen, plc, t_ns) if seen else False)
    result |= since(shown_by_moves(plc, falsified, truth, begin, machine, point, t_ns, asked))
    return result | owed_by_amount(plc, falsified, begin, seen, t_ns) if seen else result
