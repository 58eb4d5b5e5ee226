"""Judges one replay with a falsified machine or map against the truth, and sums up many of them.

Whether a frame is wrong comes from truth.csv, when it is late from attack_shows.py. Metres, seconds, degrees.
"""
import dataclasses
import math

import numpy as np

import attack_shows as shows
import campaign_judge as judge

UNSEEN = (0.05, 0.15)      # m, deg: a pose that is off by less may stay unseen for good
ACCUSED, IMPLAUSIBLE = 4, 1024  # fault bits 2 and 10
WORDS = {"travel": ("travel", "gantry"), "slew": ("slew",), "luff": ("luff",)}


@dataclasses.dataclass
class Verdict:
    """One replay of an attack, from the fault's beginning on."""
    frames: int
    healthy: int
    wrong: int           # healthy, and off by more than 5 cm or 0.1 deg
    grave: int           # healthy, and off by more than may stay unseen
    late: int            # of these when the fault has shown for 3 s
    owed: int            # frames in which it had shown for 3 s, healthy or not
    beyond: int          # frames in which a joint had been off by more than the table's amount for 3 s
    in_view: int         # of these, how many a map of the quay showed
    worst_m: float       # of healthy frames
    worst_deg: float
    shows_s: float       # from the beginning to when it first shows for 3 s; inf = nothing need ever tell
    fell_s: float        # from the beginning to health 0 after a 1; 0 = it was never 1; inf = it stayed 1
    until_s: float       # from the beginning to the last grave frame; None = there is none
    charged: int         # frames in which the machine was accused
    bit: bool            # was bit 2 or 10 set while health was 0?
    named: bool          # was the joint named then? None without a joint, or without reasons in the table
    refused: bool = False


REFUSED = Verdict(frames=0, healthy=0, wrong=0, grave=0, late=0, owed=0, beyond=0, in_view=0, worst_m=0.0, worst_deg=0.0,
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


def judge_attack(frames, truth, begin, owed_, joints=(), unseen=UNSEEN, beyond=0, in_view=0):
    """`begin`: ns; `owed_`: of each frame, as owed() says; `beyond`, `in_view`: numbers of frames. Tables of
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
                   late=int(late.sum()), owed=int(np.count_nonzero(owed_)), beyond=int(beyond), in_view=int(in_view),
                   worst_m=largest(error), worst_deg=largest(turn),
                   shows_s=since_begin(frames["t_ns"][owed_][0]) - shows.NOTICE_S if owed_.any() else math.inf,
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
