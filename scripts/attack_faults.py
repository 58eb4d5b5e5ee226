"""Machines and maps that are not what the configuration says: each attack falsifies plc.csv, hulltrackd.toml or a map.

A fault has a beginning. Columns of plc.csv as judge.read_table() gives them, m and
deg.
"""
import dataclasses
import re
import struct

import numpy as np

SECOND = 1_000_000_000
CALM_S = 8.0          # a fault that comes about later begins after so much of the run: health has had time to come
MOVES_WITHIN_S = 1.0  # a joint that starts to move goes farther than MOVES within that
JOINTS = {"travel": "d_x", "slew": "theta_r", "luff": "theta_p"}
UNITS = {"travel": "m", "slew": "deg", "luff": "deg"}
MOVES = {"travel": 0.1, "slew": 0.3, "luff": 0.1}


class NotApplicable(Exception):
    """The recording has no moment for this attack."""


@dataclasses.dataclass
class Site:
    """What a replay is given: falsified by attacks."""
    plc: dict
    config: str
    maps: dict        # file name: bytes, only those that differ from the recording's
    read_map: object  # file name -> bytes of the recording's

    def seconds(self):
        return (self.plc["t_ns"] - self.plc["t_ns"][0]) * 1e-9


@dataclasses.dataclass(frozen=True)
class Attack:
    name: str
    sentence: str
    joints: tuple      # whose values are false, so that it shows by how far they are off; else empty
    falsify: object    # Site -> ns at which the fault begins
    at_once: bool = False       # it shows from its beginning on, whatever is known of the quay
    quay_map_only: bool = False
    within_class: bool = False  # a machine that is worn as far as it may be: must not be accused


def start_of_motion(site, joint):
    """ns shortly after the joint has started to move."""
    t, v = site.seconds(), site.plc[JOINTS[joint]]
    ahead = np.interp(t + MOVES_WITHIN_S, t, v)
    starts = np.flatnonzero((t > CALM_S) & (np.abs(ahead - v) > MOVES[joint]))
    if not len(starts):
        raise NotApplicable(f"the {joint} never moves")
    return site.plc["t_ns"][starts[0]] + SECOND // 2


def value(joint, function):
    """From the first row on: value = function(values, seconds)."""
    def falsify(site):
        column = JOINTS[joint]
        site.plc[column] = function(site.plc[column], site.seconds())
        return site.plc["t_ns"][0]
    return falsify


def frozen(joint, seconds):
    def falsify(site):
        begin = start_of_motion(site, joint)
        column, t = JOINTS[joint], site.plc["t_ns"]
        stands = (t >= begin) & (t < begin + seconds * SECOND)
        site.plc[column] = np.where(stands, site.plc[column][stands][0], site.plc[column])
        return begin
    return falsify


def late(joints, seconds):
    def falsify(site):
        t = site.seconds()
        for joint in joints:
            site.plc[JOINTS[joint]] = np.interp(t - seconds, t, site.plc[JOINTS[joint]])
        return site.plc["t_ns"][0]
    return falsify


def drifting(joint, amount):
    """By `amount` within the rest of the run, a minute at most."""
    def falsify(site):
        t = site.seconds()
        site.plc[JOINTS[joint]] = site.plc[JOINTS[joint]] + amount * np.clip(
            (t - CALM_S) / min(60.0, t[-1] - CALM_S), 0.0, 1.0)
        return site.plc["t_ns"][0] + int(CALM_S * SECOND)
    return falsify


def back_elsewhere(joint, amount, gap_s=2.0):
    """No values for a while, then others."""
    def falsify(site):
        t = site.seconds()
        site.plc[JOINTS[joint]] = site.plc[JOINTS[joint]] + np.where(t >= CALM_S + gap_s, amount, 0.0)
        there = (t < CALM_S) | (t >= CALM_S + gap_s)
        begin = site.plc["t_ns"][0] + int((CALM_S + gap_s) * SECOND)
        site.plc = {name: column[there] for name, column in site.plc.items()}
        return begin
    return falsify


def words(value_):
    """High and low word of a float32."""
    return struct.unpack(">HH", struct.pack(">f", value_))


def from_words(high, low):
    return struct.unpack(">f", struct.pack(">HH", high, low))[0]


def finite_rows(site):
    """A table can hold finite numbers only: what is none is a poll without an answer."""
    finite = np.all([np.isfinite(site.plc[column]) for column in JOINTS.values()], axis=0)
    if not finite.any():
        raise NotApplicable("no value is a number")
    site.plc = {name: column[finite] for name, column in site.plc.items()}


def swapped_words(site):
    begin = site.plc["t_ns"][0]
    for column in JOINTS.values():
        site.plc[column] = np.array([from_words(*words(v)[::-1]) for v in site.plc[column]])
    finite_rows(site)
    return begin


def torn_reads(site):
    """One read in twenty has the low words of the one before."""
    begin = site.plc["t_ns"][0]
    for column in JOINTS.values():
        values = site.plc[column]
        torn = np.random.default_rng(1).random(len(values)) < 0.05
        torn[0] = False
        site.plc[column] = np.array([from_words(words(values[i])[0], words(values[i - 1])[1]) if torn[i] else v
                                     for i, v in enumerate(values)])
    finite_rows(site)
    return begin


def mount(change):
    """change(xyz, rpy_deg) of every LiDAR's mount."""
    def numbers(text):
        return [float(n) for n in text.split(",")]

    def changed(match):
        xyz, rpy = change(np.array(numbers(match[1])), np.array(numbers(match[2])))
        return "mount = { xyz = [%s], rpy_deg = [%s] }" % tuple(", ".join(f"{n:.4f}" for n in v) for v in (xyz, rpy))

    def falsify(site):
        site.config, found = re.subn(r"mount = \{ xyz = \[(.*?)\], rpy_deg = \[(.*?)\] \}", changed, site.config)
        if not found:
            raise ValueError("hulltrackd.toml has no mount")
        return site.plc["t_ns"][0]
    return falsify


def rotation(rpy):
    (cr, cp, cy), (sr, sp, sy) = np.cos(np.radians(rpy)), np.sin(np.radians(rpy))
    return (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
            @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def rpy_of(R):
    return np.degrees([np.arctan2(R[2, 1], R[2, 2]), -np.arcsin(R[2, 0]), np.arctan2(R[1, 0], R[0, 0])])


def backlash(values, width):
    """Which side of its play the joint leans to: +1 or -1 by where it went last, between where it turns round."""
    leaning, centre = np.zeros(len(values)), values[0]
    for i, v in enumerate(values):
        centre = min(max(centre, v - width), v + width)
        leaning[i] = (v - centre) / width
    return leaning


def worn(number):
    """A machine drawn from the worn class of ICD 3.1, each term evenly between its limits; the first two have every
    term at one."""
    def falsify(site):
        draw = np.random.default_rng(number)

        def term(limit, size=None):
            return limit * (draw.choice([-1.0, 1.0], size) if number <= 2 else draw.uniform(-1.0, 1.0, size))

        late(tuple(JOINTS), term(0.010))(site)
        site.plc["d_x"] = site.plc["d_x"] * (1 + term(0.001)) + term(0.03)
        for column in ("theta_r", "theta_p"):
            play = abs(term(0.10))
            site.plc[column] = site.plc[column] + play * backlash(site.plc[column], 0.2) + term(0.05)
        sag = abs(term(0.10))

        def change(xyz, rpy):
            turn = np.degrees(1.5 * sag / max(1.0, np.hypot(*xyz[:2])))  # of the end of a beam held at one end
            R = rotation(np.array([0, -turn, 0])) @ rotation(term(0.10, 3)) @ rotation(rpy)  # the true mount has sagged
            return xyz + [0, 0, sag] + term(0.02, 3), rpy_of(R)

        return mount(change)(site)
    return falsify


def header_and_points(pcd):
    end = pcd.index(b"DATA binary\n") + len(b"DATA binary\n")
    return pcd[:end], np.frombuffer(pcd[end:], dtype="<f4").reshape(-1, 3)


def points(file, function):
    def falsify(site):
        header, xyz = header_and_points(site.read_map(file))
        site.maps[file] = header + function(xyz).astype("<f4").tobytes()
        return site.plc["t_ns"][0]
    return falsify


def viewpoint(file):
    def falsify(site):
        pcd = site.read_map(file)
        site.maps[file] = re.sub(rb"(?m)^VIEWPOINT .*$", b"VIEWPOINT 0 5 0 1 0 0 0", pcd, count=1)
        return site.plc["t_ns"][0]
    return falsify


def instead(file, other):
    def falsify(site):
        site.maps[file] = site.read_map(other)
        return site.plc["t_ns"][0]
    return falsify


def turned(xyz, deg):
    """About the vertical through the middle."""
    c, s = np.cos(np.radians(deg)), np.sin(np.radians(deg))
    middle = xyz.mean(axis=0) * [1, 1, 0]
    return (xyz - middle) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + middle


def attacks_on(joint):
    unit, own = UNITS[joint], (joint,)
    yield Attack(f"{joint}-sign", "counts the other way", own, value(joint, lambda v, t: -v))
    yield Attack(f"{joint}-mirrored", "counts the other way from where it stood at first", own,
                 value(joint, lambda v, t: 2 * v[0] - v))
    for bias in (0.2, 0.5, 1.0, 3.0) if joint == "travel" else (1.0, 2.0, 5.0, 10.0):
        yield Attack(f"{joint}-bias{bias:+g}", f"{bias:g} {unit} too much", own,
                     value(joint, lambda v, t, bias=bias: v + bias))
    for percent in (1.0, 2.0, 5.0):
        yield Attack(f"{joint}-scale{percent:+g}", f"{percent:g} % too much", own,
                     value(joint, lambda v, t, k=percent / 100: v * (1 + k)))
        yield Attack(f"{joint}-gain{percent:+g}", f"moves by {percent:g} % too much from where it stood at first", own,
                     value(joint, lambda v, t, k=percent / 100: v + k * (v - v[0])))
    for seconds in (5, 20, 3600):
        span = f"for {seconds} s" if seconds < 3600 else "for good"
        yield Attack(f"{joint}-frozen" + (f"-{seconds}" if seconds < 3600 else ""),
                     f"stands still {span} while it moves, heartbeat alive", own, frozen(joint, seconds))
    yield Attack(f"{joint}-late-200", "200 ms late", own, late(own, 0.2))
    yield Attack(f"{joint}-drift", f"drifts by 0.3 {unit} within the run", own, drifting(joint, 0.3))
    wave, length = (0.05, 3.0) if joint == "travel" else (0.2, 10.0)
    yield Attack(f"{joint}-ripple", f"{wave:g} {unit} to and fro every {length:g} {unit}", own,
                 value(joint, lambda v, t: v + wave * np.sin(2 * np.pi * v / length)))
    back = 3.0 if joint == "travel" else 5.0
    yield Attack(f"{joint}-gap", f"no value for 2 s, then {back:g} {unit} too much", (),
                 back_elsewhere(joint, back), at_once=True)


def attacks_on_all_joints():
    every = tuple(JOINTS)
    for ms in (50, 100, 500):
        yield Attack(f"all-late-{ms}", f"all joints {ms} ms later than plc.latency_ms says", every,
                     late(every, ms / 1e3))
    yield Attack("words-swapped", "the wrong plc.read.word_order", (), swapped_words, True)
    yield Attack("words-torn", "one read in twenty has the low words of the one before", (), torn_reads, True)


def attacks_on_mounts():
    def turn(axis, deg):
        return mount(lambda xyz, rpy: (xyz, rpy + deg * np.eye(3)[axis]))

    yield Attack("mount-mirrored", "the LiDAR hangs on the boom's other side", (),
                 mount(lambda xyz, rpy: (xyz * [1, -1, 1], rpy * [-1, 1, -1])), at_once=True)
    yield Attack("mount-yaw90", "turned by 90 deg", (), turn(2, 90.0), at_once=True)
    for axis, name in enumerate(("roll", "pitch", "yaw")):
        yield Attack(f"mount-{name}2", f"{name} 2 deg off", (), turn(axis, 2.0))
    for axis, name in enumerate("xyz"):
        yield Attack(f"mount-{name}0.3", f"{name} 0.3 m off", (),
                     mount(lambda xyz, rpy, axis=axis: (xyz + 0.3 * np.eye(3)[axis], rpy)))


def attacks_on_maps():
    for file, short in (("hull.pcd", "hull-map"), ("quay.pcd", "quay-map")):
        quay = file == "quay.pcd"
        yield Attack(f"{short}-centimetres", "in centimetres", (), points(file, lambda xyz: 100 * xyz), True, quay)
        yield Attack(f"{short}-viewpoint", "a VIEWPOINT that is not zero", (), viewpoint(file), True, quay)
        yield Attack(f"{short}-turned", "the other way round", (), points(file, lambda xyz: turned(xyz, 180)), True,
                     quay)
    # Where the hull lies is told in her map's own coordinates: nothing can tell that these were moved.
    yield Attack("quay-map-moved", "0.4 m along the quay", (), points("quay.pcd", lambda xyz: xyz + [0.4, 0, 0]),
                 True, True)
    yield Attack("quay-map-askew", "turned by 2 deg", (), points("quay.pcd", lambda xyz: turned(xyz, 2)), True, True)
    yield Attack("quay-map-other", "the hull's map in its place", (), instead("quay.pcd", "hull.pcd"), True, True)


def all_attacks():
    """Nothing falsified first."""
    yield Attack("honest", "nothing is falsified", (), lambda site: site.plc["t_ns"][0], at_once=True,
                 within_class=True)
    for number in range(1, 7):
        yield Attack(f"worn-{number}", "worn as far as its class allows", (), worn(number), within_class=True)
    for joint in JOINTS:
        yield from attacks_on(joint)
    yield from attacks_on_all_joints()
    yield from attacks_on_mounts()
    yield from attacks_on_maps()
