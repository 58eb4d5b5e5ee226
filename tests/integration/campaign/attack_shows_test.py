"""scripts/attack_shows.py on tables made by hand: when a fault of a machine has shown."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import attack_faults as faults  # noqa: E402
import attack_shows as shows  # noqa: E402

BEGAN = 1_767_251_400_000_000_000
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
MACHINE = {"slew": {"xyz": [0.0, -8.0, 17.0]}, "luff": {"xyz": [2.0, 0.0, 3.5]}}
POINT = (0.0, 4.0, 3.0)


def at(seconds):
    return BEGAN + np.round(np.asarray(seconds) * 1e9).astype(np.int64)


def table(names, times, functions):
    return {"t_ns": at(times), **{n: np.array([functions.get(n, lambda s: 0.0)(s) for s in times]) for n in names}}


def plc(seconds, **columns):
    return table(faults.JOINTS.values(), np.arange(0, seconds + 0.005, 0.02), columns)


def truth(seconds, **columns):
    return table(POSE, np.arange(-0.5, seconds + 0.5, 0.1), columns)


def to_and_fro(way, period, until=math.inf):
    """From 0 to `way` and back within each period: a quarter of it going, a quarter standing."""
    def value(s):
        part = (min(s, until) / period) % 1.0
        return way * (min(part * 4, 1.0) if part < 0.5 else max(0.0, 1.0 - (part - 0.5) * 4))
    return value


def attack(joints, at_once=False):
    return faults.Attack("made-up", "by hand", joints, None, at_once)


def frame_times(plc_):
    return at(np.arange(0.05, (plc_["t_ns"][-1] - BEGAN) * 1e-9, 0.1))


def seen(plc_, far=True, **hidden):
    """A quay that hides so much of each joint, the table's amounts unless told."""
    t_ns = frame_times(plc_)
    amounts = {"travel": 0.13, "slew": 0.4, "luff": 0.8, **hidden}
    return shows.View(t_ns, {joint: np.broadcast_to(amount, len(t_ns)) for joint, amount in amounts.items()},
                      {joint: np.full(len(t_ns), far) for joint in amounts})


class WhenItShows(unittest.TestCase):
    def owed(self, an_attack, plc_, falsified, quay, begin=0.0, point=POINT, own=None, health=1.0):
        t_ns = frame_times(plc_)
        frames = {"t_ns": t_ns, "health": np.broadcast_to(health, len(t_ns))}
        own = own or truth(len(t_ns) * 0.1 + 1)
        return shows.owed(an_attack, plc_, falsified, own, at(begin), quay, MACHINE, point, frames)

    def shown(self, an_attack, plc_, begin=0.0, with_map=True, point=POINT, falsified=None, own=None, health=1.0,
              **hidden):
        """s, from when on it has shown; None = never."""
        quay = seen(plc_, **hidden) if with_map else None
        owed = self.owed(an_attack, plc_, falsified or plc_, quay, begin, point, own, health)
        return (frame_times(plc_)[owed][0] - BEGAN) * 1e-9 - shows.NOTICE_S if owed.any() else None

    def test_with_a_map_it_shows_while_a_joint_is_off_by_more_than_wear_hides(self):
        plc_, false = plc(30, d_x=lambda s: 30.0), plc(30, d_x=lambda s: 30.0 + 0.02 * s)
        self.assertAlmostEqual(self.shown(attack(("travel",)), plc_, falsified=false), 9.0, delta=0.11)  # 0.18 m
        self.assertIsNone(self.shown(attack(("travel",)), plc_))
        waves = plc(30, theta_r=lambda s: 0.6 * math.sin(2 * math.pi * s / 8.0))
        self.assertIsNone(self.shown(attack(("slew",)), plc(30), falsified=waves))  # never for three seconds
        slow = plc(30, theta_r=lambda s: 0.6 * math.sin(2 * math.pi * s / 12.0))  # above 0.4 deg from 1.39 to 4.61 s
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc(30), falsified=slow), 1.4, delta=0.21)

    def test_a_joint_that_the_quay_hides_does_not_show_and_one_that_it_hides_a_little_more_shows_from_there(self):
        plc_, false = plc(30), plc(30, theta_r=lambda s: 0.05 * s)
        self.assertIsNone(self.shown(attack(("slew",)), plc_, falsified=false, slew=0.7))
        self.assertIsNone(self.shown(attack(("slew",)), plc_, falsified=false, slew=math.inf))
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc_, falsified=false, slew=0.5), 10.0, delta=0.11)
        half_way = np.where(np.arange(300) < 150, math.inf, 0.4)[:len(seen(plc_).t_ns)]
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc_, falsified=false, slew=half_way), 15.0, delta=0.21)

    def test_short_breaks_of_the_view_count_and_a_long_one_ends_nothing_that_has_shown(self):
        plc_, false = plc(30), plc(30, theta_r=lambda s: 1.0)
        frames_ = np.arange(len(seen(plc_).t_ns))
        flickers = np.where(frames_ % 20 == 0, math.inf, 0.4)
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc_, falsified=false, slew=flickers), 0.15, delta=0.21)
        gone = seen(plc_, slew=np.where(frames_ > 100, math.inf, 0.4))
        owed = self.owed(attack(("slew",)), plc_, false, gone)
        self.assertTrue(owed[-1])
        mended = plc(30, theta_r=lambda s: 1.0 if s < 10 else 0.0)
        owed = self.owed(attack(("slew",)), plc_, mended, seen(plc_))
        self.assertEqual((bool(owed[98]), bool(owed[-1])), (True, False))

    def test_what_is_beyond_the_table_counts_whether_it_is_in_view_or_not(self):
        plc_, false = plc(10), plc(10, theta_r=lambda s: 1.0)
        t_ns = seen(plc_).t_ns
        count = shows.beyond_the_table(attack(("slew",)), plc_, false, at(0.0), t_ns).sum()
        self.assertEqual(count, len(t_ns) - 30)
        self.assertEqual(shows.beyond_the_table(attack(("luff",)), plc_, false, at(0.0), t_ns).sum(), 0)

    def test_a_large_error_shows_where_it_would_be_found_and_a_small_one_anywhere(self):
        for amount, far, shown in ((0.3, False, True), (0.5, False, True), (0.6, False, False), (1.0, False, False),
                                   (3.0, True, True)):
            false = plc(10, d_x=lambda s, amount=amount: amount)
            owed = self.owed(attack(("travel",)), plc(10), false, seen(plc(10), far=far))
            self.assertEqual(bool(owed.any()), shown, (amount, far))

    def test_a_mount_shows_while_the_quay_shows_all_joints(self):
        self.assertAlmostEqual(self.shown(attack(()), plc(10)), 0.05, delta=0.11)
        self.assertIsNone(self.shown(attack(()), plc(10), luff=math.inf))
        self.assertIsNone(self.shown(attack(()), plc(10), with_map=False))

    def test_the_view_is_read_from_what_replay_writes(self):
        table = {"t_ns": at([0.05]), "travel_hidden": np.array([0.1]), "slew_hidden": np.array([math.nan]),
                 "luff_hidden": np.array([0.7]), "travel_far": np.array([1]), "slew_far": np.array([0]),
                 "luff_far": np.array([1])}
        view = shows.view(table)
        self.assertEqual([view.hides(joint, at([0.05]))[0] for joint in ("travel", "slew")], [0.1, math.inf])

    def test_what_no_motion_is_needed_for_shows_at_once(self):
        self.assertAlmostEqual(self.shown(attack((), at_once=True), plc(10), begin=4.0), 4.0, delta=0.11)

    def test_without_a_map_a_joint_that_is_a_little_off_never_shows(self):
        still = plc(60, d_x=lambda s: 0.25 * s, theta_r=lambda s: 90.0)
        for name in faults.JOINTS.values():
            off = {**still, name: still[name] + 3.0}
            self.assertIsNone(self.shown(attack(tuple(faults.JOINTS)), still, with_map=False, falsified=off))

    def test_a_hull_that_would_lie_as_she_cannot_shows_and_her_own_lie_may_take_from_it(self):
        false = plc(20, theta_r=lambda s: 4.0 if s > 5 else 0.0)
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc(20), with_map=False, falsified=false), 5.0, delta=0.21)
        turned = truth(25, yaw=lambda s: -0.6)
        self.assertIsNone(self.shown(attack(("slew",)), plc(20), with_map=False, falsified=false, own=turned))
        luff = plc(20, theta_p=lambda s: 4.6)
        self.assertAlmostEqual(self.shown(attack(("luff",)), plc(20), with_map=False, falsified=luff), 0.05, delta=0.21)

    def test_a_hull_that_seems_too_fast_shows_when_she_has_run_a_metre(self):
        still = plc(60)
        slow, fast = plc(60, d_x=lambda s: 0.25 * s), plc(60, d_x=lambda s: 0.4 * max(0.0, s - 20.0))
        self.assertIsNone(self.shown(attack(("travel",)), slow, with_map=False, falsified=still))
        self.assertAlmostEqual(self.shown(attack(("travel",)), fast, with_map=False, falsified=still), 22.5, delta=0.3)
        self.assertAlmostEqual(self.shown(attack(("travel",)), fast, 23.0, with_map=False, falsified=still), 25.5,
                               delta=0.3)
        self.assertIsNone(self.shown(attack(("travel",)), fast, with_map=False))
        runs_too = truth(65, x=lambda s: 0.15 * s)
        self.assertIsNone(self.shown(attack(("travel",)), fast, with_map=False, falsified=still, own=runs_too))

    def test_a_turn_is_as_fast_as_its_lever_is_long(self):
        # 1 deg/s at 12 m: 0.21 m/s; at 24 m 0.42 m/s.
        swings, still = plc(3, theta_r=lambda s: 90 + s), plc(3, theta_r=lambda s: 90)
        speed = [shows.apparent_speed(swings, still, "slew", MACHINE, (0, y, 3))[75] for y in (4, 16)]
        np.testing.assert_allclose(speed, [np.radians(12), np.radians(24)], rtol=1e-6)
        # The luffing axis is 2 m ahead of the slewing axis and 20.5 m high: (0, 10, 4.5) is 22.6 m away.
        np.testing.assert_allclose(shows.lever(still, "luff", MACHINE, (0, 10, 4.5)), math.hypot(16, 16))

    def test_moves_to_and_fro_show_a_scale_when_the_ship_alone_would_not_do_that(self):
        slew = plc(100, theta_r=to_and_fro(16.0, 20.0))
        # A twentieth of 16 deg is eight sigma of a yaw of 0.1 deg: four moves, the last one begins at 30 s.
        false = {**slew, "theta_r": 1.05 * slew["theta_r"]}
        after = self.shown(attack(("slew",)), slew, with_map=False, falsified=false)
        self.assertAlmostEqual(after, 35.35, delta=0.3)
        self.assertIsNone(self.shown(attack(("slew",)), slew, with_map=False, falsified=slew))
        # 0.38 deg are less than a map hides, and while it confirms the joints moves are not asked.
        little_off = {**slew, "theta_r": 1.024 * slew["theta_r"]}
        self.assertIsNotNone(self.shown(attack(("slew",)), slew, with_map=False, falsified=little_off))
        self.assertIsNone(self.shown(attack(("slew",)), slew, falsified=little_off))
        slightly = {**slew, "theta_r": 1.02 * slew["theta_r"]}  # s = 0.0196
        self.assertIsNone(self.shown(attack(("slew",)), slew, with_map=False, falsified=slightly))
        # The same of 6 deg takes six moves: nine standard errors of 0.1 / 6.
        little = plc(100, theta_r=to_and_fro(6.0, 20.0))
        false = {**little, "theta_r": 1.05 * little["theta_r"]}
        self.assertAlmostEqual(self.shown(attack(("slew",)), little, with_map=False, falsified=false), 55.35, delta=0.3)

    def test_moves_one_way_unseen_ones_and_those_of_a_ship_that_moves_much_show_nothing(self):
        def stairs(s):
            return 10.0 * (s // 10) + 10.0 * min(s % 10, 4.0) / 4.0

        one_way = plc(60, theta_r=stairs)
        false = {**one_way, "theta_r": 0.96 * one_way["theta_r"]}  # its error: 2.4 deg at last
        self.assertIsNone(self.shown(attack(("slew",)), one_way, with_map=False, falsified=false))
        slew = plc(60, theta_r=to_and_fro(16.0, 20.0))
        false = {**slew, "theta_r": 1.05 * slew["theta_r"]}
        blinks = (np.arange(len(frame_times(slew))) % 20 != 0).astype(float)
        self.assertIsNone(self.shown(attack(("slew",)), slew, with_map=False, falsified=false, health=blinks))
        yaws = truth(70, yaw=lambda s: 2.0 * math.sin(s))
        self.assertIsNone(self.shown(attack(("slew",)), slew, with_map=False, falsified=false, own=yaws))

    def test_a_sign_shows_by_its_first_moves_without_a_map_where_the_bound_is_not_reached(self):
        travel = plc(100, d_x=to_and_fro(1.2, 40.0))  # 0.12 m/s
        after = self.shown(attack(("travel",)), travel, with_map=False,
                           falsified={**travel, "d_x": -travel["d_x"]})
        self.assertAlmostEqual(after, 70.35, delta=0.3)


if __name__ == "__main__":
    unittest.main()
