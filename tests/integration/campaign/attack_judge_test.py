"""scripts/attack_judge.py on tables made by hand: which frames are wrong when a fault has shown, and their sums."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import attack_judge  # noqa: E402

BEGAN = 1_767_251_400_000_000_000
POSE = ("x", "y", "z", "roll", "pitch", "yaw")


def at(seconds):
    return BEGAN + np.round(np.asarray(seconds) * 1e9).astype(np.int64)


def truth(seconds):
    t = np.arange(-0.5, seconds + 0.5, 0.01)
    return {"t_ns": at(t), **{name: np.zeros(len(t)) for name in POSE}}


def frames(count, health=1, **columns):
    table = {"t_ns": at(0.05 + 0.1 * np.arange(count)), **{name: np.zeros(count) for name in POSE}}
    for name, values in {"health": health, "faults": 0, **columns}.items():
        table[name] = np.array(values) if name == "reason" else np.broadcast_to(np.array(values, float), count).copy()
    return table


OWED = np.ones(100, dtype=bool)


def owed_from(seconds, count=100):
    return 0.05 + 0.1 * np.arange(count) > seconds


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
