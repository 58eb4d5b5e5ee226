"""scripts/attack_judge.py on tables made by hand: when a fault shows, and which frames are wrong after that."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import attack_faults as faults  # noqa: E402
import attack_judge  # noqa: E402

BEGAN = 1_767_251_400_000_000_000
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
MACHINE = {"slew": {"xyz": [0.0, -8.0, 17.0]}, "luff": {"xyz": [2.0, 0.0, 3.5]}}


def at(seconds):
    return BEGAN + np.round(np.asarray(seconds) * 1e9).astype(np.int64)


def plc(seconds, **columns):
    t = np.arange(0, seconds + 0.005, 0.02)
    table = {name: np.zeros(len(t)) for name in faults.JOINTS.values()}
    table.update({name: np.array([function(s) for s in t]) for name, function in columns.items()})
    return {"t_ns": at(t), **table}


def truth(seconds):
    t = np.arange(-0.5, seconds + 0.5, 0.01)
    return {"t_ns": at(t), **{name: np.zeros(len(t)) for name in POSE}}


def frames(count, health=1, **columns):
    table = {"t_ns": at(0.05 + 0.1 * np.arange(count)), **{name: np.zeros(count) for name in POSE}}
    for name, values in {"health": health, "faults": 0, **columns}.items():
        table[name] = np.array(values) if name == "reason" else np.broadcast_to(np.array(values, float), count).copy()
    return table


def attack(joints, without="shown"):
    return faults.Attack("made-up", "by hand", joints, None, without)


def seen(table, **hidden):
    """A quay that hides so much of each joint, the table's amounts unless told."""
    t_ns = at(np.arange(0.05, (table["t_ns"][-1] - BEGAN) * 1e-9, 0.1))
    amounts = {"travel": 0.13, "slew": 0.4, "luff": 0.8, **hidden}
    return attack_judge.View(t_ns, {joint: np.broadcast_to(amount, len(t_ns)) for joint, amount in amounts.items()})


OWED = np.ones(100, dtype=bool)


def owed_from(seconds, count=100):
    return 0.05 + 0.1 * np.arange(count) > seconds


class WhenItShows(unittest.TestCase):
    def shown(self, an_attack, table, begin=0.0, with_map=True, point=(0, 4, 3), falsified=None, **hidden):
        """s, from when on it has shown; None = never."""
        t_ns = at(np.arange(0.05, (table["t_ns"][-1] - BEGAN) * 1e-9, 0.1))
        owed = attack_judge.owed(an_attack, table, falsified or table, at(begin),
                                 seen(table, **hidden) if with_map else None, MACHINE, point, t_ns)
        return (t_ns[owed][0] - BEGAN) * 1e-9 - attack_judge.NOTICE_S if owed.any() else None

    def test_without_a_map_a_joint_has_to_move_two_metres_or_ten_degrees_after_the_beginning(self):
        table = plc(60, d_x=lambda s: 0.1 * s, theta_r=lambda s: 90 + s)
        self.assertAlmostEqual(self.shown(attack(("travel",)), table, with_map=False), 20.0, delta=0.11)
        self.assertAlmostEqual(self.shown(attack(("travel",)), table, begin=15.0, with_map=False), 35.0, delta=0.11)
        self.assertAlmostEqual(self.shown(attack(("slew",)), table, with_map=False), 10.0, delta=0.11)
        self.assertIsNone(self.shown(attack(("luff",)), table, with_map=False))
        self.assertAlmostEqual(self.shown(attack(("travel", "slew", "luff")), table, with_map=False), 10.0, delta=0.11)

    def test_the_way_there_and_back_counts_as_one_motion(self):
        table = plc(30, d_x=lambda s: min(s, 10.0) * -0.11 + max(0.0, min(s - 10, 10.0)) * 0.21)
        self.assertAlmostEqual(self.shown(attack(("travel",)), table, with_map=False), 19.52, delta=0.11)

    def test_with_a_map_it_shows_while_a_joint_is_off_by_more_than_wear_hides(self):
        table, false = plc(30, d_x=lambda s: 30.0), plc(30, d_x=lambda s: 30.0 + 0.02 * s)
        self.assertAlmostEqual(self.shown(attack(("travel",)), table, falsified=false), 9.0, delta=0.11)  # 0.18 m
        self.assertIsNone(self.shown(attack(("travel",)), table))
        waves = plc(30, theta_r=lambda s: 0.6 * math.sin(2 * math.pi * s / 8.0))
        self.assertIsNone(self.shown(attack(("slew",)), plc(30), falsified=waves))  # never for three seconds
        slow = plc(30, theta_r=lambda s: 0.6 * math.sin(2 * math.pi * s / 12.0))  # above 0.4 deg from 1.39 to 4.61 s
        self.assertAlmostEqual(self.shown(attack(("slew",)), plc(30), falsified=slow), 1.4, delta=0.21)

    def test_a_joint_that_the_quay_hides_does_not_show_and_one_that_it_hides_a_little_more_shows_from_there(self):
        table, false = plc(30), plc(30, theta_r=lambda s: 0.05 * s)
        self.assertIsNone(self.shown(attack(("slew",)), table, falsified=false, slew=0.7))
        self.assertIsNone(self.shown(attack(("slew",)), table, falsified=false, slew=math.inf))
        self.assertAlmostEqual(self.shown(attack(("slew",)), table, falsified=false, slew=0.5), 10.0, delta=0.11)
        half_way = np.where(np.arange(300) < 150, math.inf, 0.4)[:len(seen(table).t_ns)]
        self.assertAlmostEqual(self.shown(attack(("slew",)), table, falsified=false, slew=half_way), 15.0, delta=0.21)

    def test_short_breaks_of_the_view_count_and_a_long_one_ends_nothing_that_has_shown(self):
        table, false = plc(30), plc(30, theta_r=lambda s: 1.0)
        frames_ = np.arange(len(seen(table).t_ns))
        flickers = np.where(frames_ % 20 == 0, math.inf, 0.4)
        self.assertAlmostEqual(self.shown(attack(("slew",)), table, falsified=false, slew=flickers), 0.15, delta=0.21)
        t_ns = seen(table).t_ns
        gone = seen(table, slew=np.where(frames_ > 100, math.inf, 0.4))
        owed = attack_judge.owed(attack(("slew",)), table, false, at(0.0), gone, MACHINE, (0, 4, 3), t_ns)
        self.assertTrue(owed[-1])
        mended = plc(30, theta_r=lambda s: 1.0 if s < 10 else 0.0)
        owed = attack_judge.owed(attack(("slew",)), table, mended, at(0.0), seen(table), MACHINE, (0, 4, 3), t_ns)
        self.assertEqual((bool(owed[98]), bool(owed[-1])), (True, False))

    def test_what_is_beyond_the_table_counts_whether_it_is_in_view_or_not(self):
        table, false = plc(10), plc(10, theta_r=lambda s: 1.0)
        t_ns = seen(table).t_ns
        count = attack_judge.beyond_the_table(attack(("slew",)), table, false, at(0.0), t_ns).sum()
        self.assertEqual(count, len(t_ns) - 30)
        self.assertEqual(attack_judge.beyond_the_table(attack(("luff",)), table, false, at(0.0), t_ns).sum(), 0)

    def test_a_mount_shows_while_the_quay_shows_all_joints(self):
        self.assertAlmostEqual(self.shown(attack((), "never"), plc(10)), 0.05, delta=0.11)
        self.assertIsNone(self.shown(attack((), "never"), plc(10), luff=math.inf))
        self.assertIsNone(self.shown(attack((), "never"), plc(10), with_map=False))

    def test_the_view_is_read_from_what_replay_writes(self):
        table = {"t_ns": at([0.05]), "travel_hidden": np.array([0.1]), "slew_hidden": np.array([math.nan]),
                 "luff_hidden": np.array([0.7])}
        view = attack_judge.view(table)
        self.assertEqual([view.hides(joint, at([0.05]))[0] for joint in ("travel", "slew")], [0.1, math.inf])

    def test_what_no_motion_is_needed_for_shows_at_once(self):
        self.assertAlmostEqual(self.shown(attack(()), plc(10), begin=4.0), 4.0, delta=0.11)

    def test_without_a_map_some_never_show_and_others_by_the_speed_that_the_hull_seems_to_have(self):
        table = plc(60, d_x=lambda s: 0.25 * min(s, 20.0) + 0.4 * max(0.0, s - 20.0))
        self.assertIsNone(self.shown(attack(("travel",), "never"), table, with_map=False))
        # 0.4 m/s from 20 s on, seen over half a second, for half a second.
        self.assertAlmostEqual(self.shown(attack(("travel",), "speed"), table, with_map=False), 20.5, delta=0.3)
        slow = plc(60, d_x=lambda s: 0.25 * s)
        self.assertIsNone(self.shown(attack(("travel",), "speed"), slow, with_map=False))

    def test_a_turn_is_as_fast_as_its_lever_is_long(self):
        # 1 deg/s at 12 m: 0.21 m/s; at 24 m 0.42 m/s.
        table = plc(30, theta_r=lambda s: 90 + s)
        self.assertIsNone(self.shown(attack(("slew",), "speed"), table, with_map=False, point=(0, 4, 3)))
        self.assertIsNotNone(self.shown(attack(("slew",), "speed"), table, with_map=False, point=(0, 16, 3)))
        # The luffing axis is 2 m ahead of the slewing axis and 20.5 m high: (0, 10, 4.5) is 22.6 m away.
        at_90 = plc(30, theta_r=lambda s: 90.0)
        np.testing.assert_allclose(attack_judge.lever(at_90, "luff", MACHINE, (0, 10, 4.5)), math.hypot(16, 16))


class WhatIsWrong(unittest.TestCase):
    def test_healthy_frames_that_are_off_count_from_the_beginning_on_and_as_late_three_seconds_after_it_shows(self):
        x = np.full(100, 0.06)
        verdict = attack_judge.judge_attack(frames(100, x=x), truth(10), at(2.0), owed_from(7.0))
        self.assertEqual((verdict.frames, verdict.healthy, verdict.wrong, verdict.grave), (80, 80, 80, 80))
        self.assertEqual(verdict.late, 30)  # 7.05 s to 9.95 s
        self.assertAlmostEqual(verdict.worst_m, 0.06)
        self.assertAlmostEqual(verdict.until_s, 7.95)
        self.assertEqual(verdict.fell_s, math.inf)

    def test_a_turn_of_a_tenth_of_a_degree_is_wrong_and_of_more_than_0_15_grave(self):
        yaw = np.where(np.arange(100) < 50, 0.12, 0.16)
        verdict = attack_judge.judge_attack(frames(100, yaw=yaw), truth(10), at(0.0), OWED)
        self.assertEqual((verdict.wrong, verdict.grave, verdict.late), (100, 50, 50))
        self.assertAlmostEqual(verdict.worst_deg, 0.16)

    def test_how_much_may_stay_unseen_can_be_told(self):
        yaw = np.where(np.arange(100) < 50, 0.3, 0.5)
        verdict = attack_judge.judge_attack(frames(100, x=0.1, yaw=yaw), truth(10), at(0.0), OWED,
                                            unseen=(0.15, 0.4))
        self.assertEqual((verdict.wrong, verdict.grave), (100, 50))

    def test_what_never_shows_is_never_late(self):
        verdict = attack_judge.judge_attack(frames(100, x=1.0), truth(10), at(0.0), ~OWED)
        self.assertEqual((verdict.grave, verdict.late, verdict.shows_s), (100, 0, math.inf))

    def test_frames_without_health_are_never_wrong(self):
        health = np.arange(100) < 30
        verdict = attack_judge.judge_attack(frames(100, health=health, x=1.0), truth(10), at(2.0), owed_from(5.0))
        self.assertEqual((verdict.wrong, verdict.late), (10, 0))
        self.assertAlmostEqual(verdict.fell_s, 1.05)

    def test_healthy_without_a_pose_is_infinitely_wrong(self):
        verdict = attack_judge.judge_attack(frames(50, x=math.nan), truth(5), at(0.0), OWED[:50])
        self.assertEqual((verdict.wrong, verdict.grave, verdict.worst_m), (50, 50, math.inf))

    def test_health_that_came_and_went_fell_when_it_went_and_one_that_never_came_at_once(self):
        i = np.arange(100)
        verdict = attack_judge.judge_attack(frames(100, health=(i >= 20) & (i < 60)), truth(10), at(0.0), ~OWED)
        self.assertAlmostEqual(verdict.fell_s, 6.05)
        self.assertEqual(attack_judge.judge_attack(frames(100, health=0), truth(10), at(0.0), ~OWED).fell_s, 0.0)


class WhatWasSaid(unittest.TestCase):
    def judged(self, joints=("slew",), **columns):
        health = np.arange(100) < 50
        return attack_judge.judge_attack(frames(100, health=health, **columns), truth(10), at(0.0), ~OWED, joints)

    def test_bit_2_or_10_while_health_is_0(self):
        self.assertTrue(self.judged(faults=1 << 2).bit)
        self.assertTrue(self.judged(faults=1 << 10).bit)
        self.assertFalse(self.judged(faults=1 << 9).bit)
        self.assertFalse(self.judged(faults=np.where(np.arange(100) < 50, 1 << 2, 0)).bit)

    def test_the_reason_names_the_joint_or_nobody_knows(self):
        def reasons(text):
            return np.array([""] * 50 + [text] * 50)
        self.assertTrue(self.judged(reason=reasons("the slew's value contradicts the quay")).named)
        self.assertFalse(self.judged(reason=reasons("the luff's value contradicts the quay")).named)
        self.assertIsNone(self.judged().named)
        self.assertIsNone(self.judged(joints=(), reason=reasons("map")).named)


class Sums(unittest.TestCase):
    def test_runs_add_up_and_refused_ones_are_counted(self):
        one = attack_judge.judge_attack(frames(100, x=0.06), truth(10), at(0.0), OWED)
        other = attack_judge.judge_attack(frames(50, health=0, faults=4), truth(5), at(0.0), OWED[:50])
        row = attack_judge.summary([one, other, attack_judge.REFUSED])
        self.assertEqual([row[name] for name in ("runs", "refused", "frames", "healthy", "wrong", "late",
                                                "charged")], [3, 1, 150, 100, 100, 100, 50])
        self.assertEqual((row["bit"], row["named"], row["fell_s"]), ("1/2", "-", math.inf))
        self.assertAlmostEqual(row["worst_m"], 0.06)
        self.assertIsNone(attack_judge.summary([other])["until_s"])


if __name__ == "__main__":
    unittest.main()
