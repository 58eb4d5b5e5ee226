"""Judges one replay of a simulated recording against the truth, and sums up many of them.

Everything that decides whether a frame could have been healthy, or must not have been, comes from truth.csv and
returns.csv of the simulation, never from what the tracker said. Metres, seconds, degrees where a name says so, radians
otherwise; error twists are [rotation; translation of the reference point], found minus true, in W.
"""
import csv
import dataclasses
import math

import numpy as np

FALSE_ERROR_M, FALSE_TURN_DEG = 0.05, 0.1  # a healthy frame that is further off is a false one
GROSS_ERROR_M, GROSS_TURN_DEG = 0.10, 0.3
NOTICE_S = 0.5     # what the tracker has to notice that the ship is under way
START_S = 1.0      # nobody is healthy before that: recover_frames
MERGE_S = 1.0      # disturbances closer to each other are one
COME_BACK_S = 2.0  # a shorter rest of a recording does not tell whether health comes back
# 95 % of chi-square with six degrees of freedom lies between these quantiles of 2.5 and 97.5 %.
NEES_BAND = (1.24, 14.45)
BLIND_SHARE = 0.1  # of the returns of a usual frame
COVARIANCE = ["c_%s_%s" % (a, b) for i, a in enumerate(("rx", "ry", "rz", "x", "y", "z"))
              for b in ("rx", "ry", "rz", "x", "y", "z")[i:]]

@dataclasses.dataclass
class Limits:
    """What [hull] of the configuration demands of a ship at the berth."""
    max_speed: float = 0.3                             # m/s
    envelope: tuple = (-15, -2, -10, 15, 2, 10)        # displacements, least and largest, m


@dataclasses.dataclass
class Verdict:
    """One replay, frame by frame, and its disturbances. Or many replays, joined."""
    could: np.ndarray       # the frame could have been healthy
    healthy: np.ndarray
    false: np.ndarray       # healthy and must not be
    gross: np.ndarray
    accurate: np.ndarray    # healthy, and it is the ship of the map: error and NEES count
    there: np.ndarray       # the ship of the map lies inside the envelope, whatever health says
    error: np.ndarray       # at the reference point, m; NaN without a pose
    turn_deg: np.ndarray
    nees: np.ndarray        # NaN without covariance
    ms: np.ndarray
    notice: list            # s from a disturbance to health 0; inf = health stayed 1
    back: list              # s from its end to health 1; inf = not in the rest of the recording
    bend_error: list        # m, of the last estimate; none without one or without a truth

    @staticmethod
    def join(verdicts):
        parts = [dataclasses.astuple(v) for v in verdicts]
        return Verdict(*(sum(p, []) if isinstance(p[0], list) else np.concatenate(p) for p in zip(*parts)))


def read_table(path):
    """Columns of a CSV file by name: t_ns as integers, reason as text, all else as float with NaN for empty."""
    with open(path, newline="") as stream:
        header, *rows = csv.reader(stream)
    columns = dict(zip(header, zip(*rows) if rows else [()] * len(header)))
    kinds = {"t_ns": np.int64, "reason": str}
    return {name: np.array(values, dtype=kinds[name]) if name in kinds else
            np.array([float(v) if v else math.nan for v in values]) for name, values in columns.items()}


def blind_frames(returns, t_ns, period_ns):
    """In which frames the LiDARs saw next to nothing. `returns`: a row a frame; t_ns: the frames' middles."""
    frame = (returns["t_ns"] - t_ns[0] + period_ns // 2) // period_ns
    position = (t_ns - t_ns[0] + period_ns // 2) // period_ns
    inside = (frame >= 0) & (frame <= position[-1])
    counts = np.bincount(frame[inside], weights=returns["returns"][inside], minlength=position[-1] + 1)[position]
    return counts < BLIND_SHARE * np.percentile(counts, 90)


def rotations(rpy):
    """Rz(yaw) Ry(pitch) Rx(roll) of n rows of rad, as n x 3 x 3."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy).T, np.sin(rpy).T
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                     [-sp, cp * sr, cp * cr]]).transpose(2, 0, 1)


def rotation_vectors(R):
    """Logarithms of n rotations by less than 180 deg."""
    twice_sine = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    sine = np.linalg.norm(twice_sine, axis=1) / 2
    angle = np.arctan2(sine, (np.trace(R, axis1=1, axis2=2) - 1) / 2)
    return twice_sine / 2 * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 1.0)[:, None]


def error_twists(frames, truth):
    """Of each frame; NaN where nothing was registered."""
    def at_frames(name):
        zero = truth["t_ns"][0]
        return np.interp(frames["t_ns"] - zero, truth["t_ns"] - zero, truth[name])
    found = {name: frames[name] for name in ("x", "y", "z", "roll", "pitch", "yaw")}
    true = {name: at_frames(name) for name in found}
    R_found, R_true = (rotations(np.radians(np.stack([pose["roll"], pose["pitch"], pose["yaw"]], axis=1)))
                       for pose in (found, true))
    translation = np.stack([found[name] - true[name] for name in ("x", "y", "z")], axis=1)
    return np.hstack([rotation_vectors(R_found @ R_true.transpose(0, 2, 1)), translation])


def normalised_squares(frames, twists):
    """Squared errors in units of the covariance that the tracker states (NEES)."""
    nees = np.full(len(twists), math.nan)
    if COVARIANCE[0] not in frames:
        return nees
    upper = np.stack([frames[name] for name in COVARIANCE], axis=1)
    known = np.isfinite(upper).all(axis=1) & np.isfinite(twists).all(axis=1)
    covariance = np.zeros((np.count_nonzero(known), 6, 6))
    rows, columns = np.triu_indices(6)
    covariance[:, rows, columns] = covariance[:, columns, rows] = upper[known]
    # A covariance that is singular promises an error of zero: infinitely wrong, unless it is zero.
    definite = np.linalg.eigvalsh(covariance)[:, 0] > 0
    squares = np.full(len(covariance), math.inf)
    e = twists[known][definite][:, :, None]
    squares[definite] = (e.transpose(0, 2, 1) @ np.linalg.solve(covariance[definite], e))[:, 0, 0]
    nees[known] = squares
    return nees


def spells(flags, t_ns):
    """(begin, end) in ns of each run of true flags; end is the first time after it, or None. Near ones are one."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    begins, ends = edges[::2], edges[1::2]
    apart = t_ns[begins[1:]] - t_ns[ends[:-1]] >= MERGE_S * 1e9
    begins, ends = begins[np.append([True], apart)[:len(begins)]], ends[np.append(apart, [True])[:len(ends)]]
    return [(t_ns[begin], t_ns[end] if end < len(t_ns) else None) for begin, end in zip(begins, ends)]


def seconds_to_notice(begin, end, t_ns, healthy):
    """From a disturbance to health 0; inf = health stayed 1; None = it was over before anybody had to notice."""
    if not np.any(healthy[t_ns < begin][-1:]):
        return 0.0
    fallen = t_ns[(t_ns >= begin) & ~healthy]
    last = t_ns[-1] if end is None else end
    if len(fallen) and fallen[0] <= last:
        return (fallen[0] - begin) * 1e-9
    return math.inf if last - begin > NOTICE_S * 1e9 else None


def seconds_to_come_back(end, t_ns, healthy):
    back = t_ns[(t_ns >= end) & healthy]
    if len(back):
        return (back[0] - end) * 1e-9
    return math.inf if t_ns[-1] - end >= COME_BACK_S * 1e9 else None


def away_rows(truth, limits, frames_t_ns, blind, period_ns):
    """At which rows of the truth nobody asks for a pose (under way, outside, blind), and where it is outside."""
    xyz = np.stack([truth[name] for name in ("x", "y", "z")], axis=1)
    seconds = (truth["t_ns"] - truth["t_ns"][0]) * 1e-9
    moving = np.linalg.norm(np.gradient(xyz, seconds, axis=0), axis=1) > limits.max_speed
    outside = np.any((xyz < limits.envelope[:3]) | (xyz > limits.envelope[3:]), axis=1)
    nearest = (truth["t_ns"] - frames_t_ns[0] + period_ns // 2) // period_ns  # number of a frame without gaps
    numbers = (frames_t_ns - frames_t_ns[0] + period_ns // 2) // period_ns
    return moving | outside | np.isin(nearest, numbers[blind]), outside


def within(error, turn_deg):
    """Which poses are near enough to be healthy; where there is none it is not."""
    return (error <= FALSE_ERROR_M) & (turn_deg <= FALSE_TURN_DEG)


def judge(frames, truth, limits, mapped, returns=None):
    """Verdict on one replay. Tables of read_table(); `mapped`: the ship of the map lies there."""
    t_ns = frames["t_ns"]
    period_ns = int(np.median(np.diff(t_ns))) if len(t_ns) > 1 else 100_000_000
    blind = blind_frames(returns, t_ns, period_ns) if returns else np.zeros(len(t_ns), dtype=bool)
    away, outside = away_rows(truth, limits, t_ns, blind, period_ns)
    row = np.minimum(np.searchsorted(truth["t_ns"], t_ns), len(away) - 1)
    healthy = frames["health"] == 1

    twists = error_twists(frames, truth)
    error = np.linalg.norm(twists[:, 3:], axis=1)
    turn_deg = np.degrees(np.linalg.norm(twists[:, :3], axis=1))
    gone = np.zeros(len(t_ns), dtype=bool)
    for begin, end in spells(outside, truth["t_ns"]):
        gone |= (t_ns > begin + NOTICE_S * 1e9) & ((end is None) | (t_ns < (end or 0)))
    near = within(error, turn_deg)
    roughly = (error <= GROSS_ERROR_M) & (turn_deg <= GROSS_TURN_DEG)
    false = healthy & ~(near & ~gone & mapped)

    notice, back, bend_error = [], [], []
    if mapped:
        disturbances = [(begin, end) for begin, end in spells(away, truth["t_ns"])
                        if begin <= t_ns[-1] and (end is None or end > t_ns[0])]
        notice = [seconds_to_notice(b, e, t_ns, healthy) for b, e in disturbances if b > t_ns[0]]
        notice += [math.inf if e is None else (e - b) * 1e-9 for b, e in spells(false, t_ns)]
        back = [seconds_to_come_back(e, t_ns, healthy) for _, e in disturbances if e is not None]
        known = np.flatnonzero(np.isfinite(frames.get("bend", [])))
        if len(known) and "bend" in truth:
            last, zero = known[-1], truth["t_ns"][0]
            true_bend = np.interp(t_ns[last] - zero, truth["t_ns"] - zero, truth["bend"])
            bend_error = [abs(frames["bend"][last] - true_bend)]
    return Verdict(could=mapped & ~away[row] & (t_ns - t_ns[0] >= START_S * 1e9), healthy=healthy, false=false,
                   gross=healthy & ~(roughly & ~gone & mapped), accurate=healthy & mapped,
                   there=mapped & ~outside[row], error=error, turn_deg=turn_deg,
                   nees=normalised_squares(frames, twists), ms=frames["ms"],
                   notice=[s for s in notice if s is not None], back=[s for s in back if s is not None],
                   bend_error=bend_error)


def percent(part, whole):
    return 100.0 * np.count_nonzero(part) / np.count_nonzero(whole) if np.any(whole) else None


def of(values, figure, *arguments):
    return float(figure(values, *arguments)) if len(values) else None


def root_mean_square(values):
    return np.sqrt(np.mean(np.square(values)))


def summary_of_any_pose(v):
    """How good the method's poses are, whether or not anybody would be told to believe them."""
    posed = v.there & np.isfinite(v.error)
    error, turn = v.error[posed], v.turn_deg[posed]
    return {"there": np.count_nonzero(v.there), "no_pose_%": percent(v.there & ~posed, v.there),
            "off_%": percent(posed & ~within(v.error, v.turn_deg), posed),
            "any_p50_m": of(error, np.median), "any_p95_m": of(error, np.percentile, 95),
            "any_p50_deg": of(turn, np.median), "any_p95_deg": of(turn, np.percentile, 95)}


def summary(verdict):
    """The figures of a verdict by column of the table; None = there is none."""
    v = verdict
    error_mm, turn, nees = 1e3 * v.error[v.accurate], v.turn_deg[v.accurate], v.nees[v.accurate]
    nees, ms = nees[~np.isnan(nees)], v.ms[~np.isnan(v.ms)]
    return {"frames": len(v.could), "could": np.count_nonzero(v.could), "avail_%": percent(v.could & v.healthy, v.could),
            "healthy": np.count_nonzero(v.healthy), "false": np.count_nonzero(v.false),
            "gross": np.count_nonzero(v.gross), "rms_mm": of(error_mm, root_mean_square),
            "p95_mm": of(error_mm, np.percentile, 95), "p99_mm": of(error_mm, np.percentile, 99),
            "max_mm": of(error_mm, np.max), "rms_deg": of(turn, root_mean_square), "max_deg": of(turn, np.max),
            "notice_s": max(v.notice, default=None), "back_s": max(v.back, default=None),
            "nees": of(nees, np.mean),
            "band_%": percent((nees >= NEES_BAND[0]) & (nees <= NEES_BAND[1]), nees == nees),
            "bend_mm": 1e3 * max(v.bend_error) if v.bend_error else None,
            "ms_p50": of(ms, np.median), "ms_p99": of(ms, np.percentile, 99), **summary_of_any_pose(v)}
