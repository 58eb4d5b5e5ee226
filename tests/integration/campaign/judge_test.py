"""scripts/campaign_judge.py on tables made by hand, whose figures follow from closed forms."""
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import campaign_judge as judge  # noqa: E402

BEGAN = 1_767_251_400_000_000_000
POSE = ("x", "y", "z", "roll", "pitch", "yaw")


def truth(seconds, **columns):
    """Rows every 10 ms from 0.5 s before frame 0 to 0.5 s after the last; columns are functions of s, m and deg."""
    t = np.arange(-0.5, seconds + 0.505, 0.01)
    table = {name: np.zeros(len(t)) for name in POSE}
    table.update({name: np.array([function(s) for s in t]) for name, function in columns.items()})
    return {"t_ns": BEGAN + np.round(t * 1e9).astype(np.int64), **table}


def times(count):
    return 0.05 + 0.1 * np.arange(count)


def frames(count, health=1, **columns):
    """A frame every 0.1 s; columns are numbers or arrays."""
    table = {"t_ns": BEGAN + np.round(times(count) * 1e9).astype(np.int64),
             **{name: np.zeros(count) for name in POSE}, "ms": np.full(count, 2.0)}
    table.update({name: np.broadcast_to(np.array(values, dtype=float), count).copy()
                  for name, values in {"health": health, **columns}.items()})
    return table


def judged(*arguments, mapped=True, returns=None):
    return judge.judge(*arguments, judge.Limits(), mapped, returns)


def covariance(count, **entries):
    """Columns of a covariance that is the identity but for the entries."""
    diagonal = {name: 1.0 for name in judge.COVARIANCE if name.split("_")[1] == name.split("_")[2]}
    return {name: np.full(count, {**diagonal, **entries}.get(name, 0.0)) for name in judge.COVARIANCE}


class Tables(unittest.TestCase):
    def test_numbers_are_numbers_and_reasons_stay_words(self):
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as table:
            table.write('t_ns,health,x,reason\n1767251400050000001,1,,\n'
                        '1767251400150000001,0,0.5,"slew, or luff: off"\n')
            table.flush()
            columns = judge.read_table(table.name)
        self.assertEqual(list(columns["t_ns"]), [1767251400050000001, 1767251400150000001])
        self.assertTrue(math.isnan(columns["x"][0]))
        self.assertEqual(list(columns["reason"]), ["", "slew, or luff: off"])


class Errors(unittest.TestCase):
    def test_truth_is_interpolated_between_its_rows(self):
        moved = frames(30, x=0.2 * (times(30) + 0.003), yaw=0.5 * (times(30) + 0.003))
        moved["t_ns"] += 3_000_000
        verdict = judged(moved, truth(3, x=lambda s: 0.2 * s, yaw=lambda s: 0.5 * s))
        self.assertLess(np.max(verdict.error), 1e-9)
        self.assertLess(np.max(verdict.turn_deg), 1e-9)

    def test_the_rotation_error_is_a_turn_about_the_axes_of_the_quay(self):
        # A ship that lies at yaw 90 deg, found turned by 0.1 rad about the quay's x: that is minus its own y.
        found = frames(3, yaw=90.0, pitch=-math.degrees(0.1), x=0.03, y=-0.04)
        twist = judge.error_twists(found, truth(1, yaw=lambda s: 90.0))
        np.testing.assert_allclose(twist, [[0.1, 0, 0, 0.03, -0.04, 0]] * 3, atol=1e-12)

    def test_figures_of_known_errors(self):
        errors = np.array([0.003, 0.004] * 50)
        row = judge.summary(judged(frames(100, x=errors, yaw=0.05), truth(10)))
        self.assertAlmostEqual(row["rms_mm"], math.sqrt((9 + 16) / 2))
        self.assertAlmostEqual(row["p95_mm"], 4.0)
        self.assertAlmostEqual(row["max_mm"], 4.0)
        self.assertAlmostEqual(row["rms_deg"], 0.05)
        self.assertAlmostEqual(row["ms_p50"], 2.0)
        self.assertEqual((row["frames"], row["healthy"], row["false"], row["could"]), (100, 100, 0, 90))
        self.assertIsNone(row["nees"])
        self.assertIsNone(row["notice_s"])


class FalseHealthy(unittest.TestCase):
    def test_a_frame_that_is_off_counts_only_while_health_is_1(self):
        x, yaw, health = np.zeros(60), np.zeros(60), np.ones(60)
        x[20] = 0.0501
        yaw[35] = 0.1001
        x[40] = 0.0499
        yaw[41] = 0.0999
        x[50] = 5.0
        health[50] = 0
        row = judge.summary(judged(frames(60, x=x, yaw=yaw, health=health), truth(6)))
        self.assertEqual((row["false"], row["gross"]), (2, 0))
        self.assertAlmostEqual(row["notice_s"], 0.1)

    def test_gross_ones_are_counted_apart(self):
        x = np.where(np.arange(60) == 20, 0.101, np.where(np.arange(60) == 40, 0.099, 0.0))
        row = judge.summary(judged(frames(60, x=x), truth(6)))
        self.assertEqual((row["false"], row["gross"]), (2, 1))

    def test_another_ship_is_never_right(self):
        row = judge.summary(judged(frames(30), truth(3), mapped=False))
        self.assertEqual((row["false"], row["gross"], row["could"]), (30, 30, 0))
        self.assertIsNone(row["avail_%"])
        self.assertIsNone(row["rms_mm"])

    def test_healthy_without_a_pose_is_false(self):
        row = judge.summary(judged(frames(30, x=math.nan), truth(3)))
        self.assertEqual(row["false"], 30)

    def test_a_ship_outside_the_envelope_is_gone_after_half_a_second_however_well_it_is_tracked(self):
        # Leaves at y = 2 m after 20 s; frames 200.. are outside, those from 20.51 s on are false.
        row = judge.summary(judged(frames(300, y=0.1 * times(300)), truth(30, y=lambda s: 0.1 * s)))
        self.assertEqual(row["false"], np.count_nonzero(times(300) > 20.51))
        self.assertEqual(row["could"], np.count_nonzero((times(300) >= 1.05) & (times(300) < 20.0)))


class AnyPose(unittest.TestCase):
    def test_a_pose_counts_whatever_health_says_and_no_pose_is_no_error(self):
        # 40 frames off by 4 mm, 40 by 0.2 m and 0.3 deg, 20 without a pose; never healthy.
        i = np.arange(100)
        x = np.where(i < 40, 0.004, np.where(i < 80, 0.2, math.nan))
        row = judge.summary(judged(frames(100, x=x, yaw=np.where(i < 40, 0.0, 0.3), health=0), truth(10)))
        self.assertIsNone(row["rms_mm"])
        self.assertEqual(row["there"], 100)
        self.assertAlmostEqual(row["no_pose_%"], 20.0)
        self.assertAlmostEqual(row["off_%"], 50.0)
        self.assertAlmostEqual(row["any_p50_m"], (0.004 + 0.2) / 2)
        self.assertAlmostEqual(row["any_p95_m"], 0.2)
        self.assertAlmostEqual(row["any_p50_deg"], 0.15)
        self.assertAlmostEqual(row["any_p95_deg"], 0.3)

    def test_a_pose_is_off_by_its_place_or_by_its_rotation(self):
        x = np.array([0.0499, 0.0501, 0.0, 0.0])
        yaw = np.array([0.0, 0.0, 0.0999, 0.1001])
        self.assertAlmostEqual(judge.summary(judged(frames(4, x=x, yaw=yaw), truth(1)))["off_%"], 50.0)

    def test_a_ship_under_way_is_there_until_it_is_outside_the_envelope(self):
        # At 1 m/s out of y = 2 m after 2 s, followed by nobody.
        row = judge.summary(judged(frames(30, health=0), truth(3, y=lambda s: 1.0 * s)))
        self.assertEqual((row["could"], row["there"]), (0, 20))
        self.assertAlmostEqual(row["any_p50_m"], np.median(times(20)))

    def test_another_ship_has_no_such_figures(self):
        row = judge.summary(judged(frames(30), truth(3), mapped=False))
        self.assertEqual(row["there"], 0)
        self.assertEqual([row[name] for name in ("no_pose_%", "off_%", "any_p50_m", "any_p95_deg")], [None] * 4)

    def test_without_a_pose_in_any_frame_there_is_no_error(self):
        row = judge.summary(judged(frames(30, health=0, **{name: math.nan for name in POSE}), truth(3)))
        self.assertAlmostEqual(row["no_pose_%"], 100.0)
        self.assertEqual([row[name] for name in ("off_%", "any_p50_m", "any_p95_deg")], [None] * 3)


class Reaction(unittest.TestCase):
    def test_time_to_notice_runs_from_the_moment_at_which_the_hull_passes_max_speed(self):
        # 0.1 m/s2 passes 0.3 m/s at 3.00 s; health falls with the frame at 3.35 s.
        def x(s):
            return 0.05 * s * s if s > 0 else 0.0
        found = frames(60, x=[x(s) for s in times(60)], health=times(60) < 3.3)
        row = judge.summary(judged(found, truth(6, x=x)))
        self.assertAlmostEqual(row["notice_s"], 0.35, delta=0.011)
        self.assertEqual(row["could"], 20)
        self.assertIsNone(row["back_s"])

    def test_health_that_was_0_before_needs_no_time(self):
        row = judge.summary(judged(frames(60, x=times(60) ** 2 / 20, health=times(60) < 2.5),
                                   truth(6, x=lambda s: 0.05 * s * abs(s))))
        self.assertEqual(row["notice_s"], 0.0)

    def test_health_that_stays_1_is_never(self):
        row = judge.summary(judged(frames(60, x=times(60) ** 2 / 20), truth(6, x=lambda s: 0.05 * s * abs(s))))
        self.assertEqual(row["notice_s"], math.inf)

    def test_time_to_come_back_runs_from_the_end_of_the_disturbance(self):
        # 1 m at 0.5 m/s from 3 s to 5 s; health 0 from 3.35 s to before 6.25 s.
        def x(s):
            return 0.5 * min(max(s - 3.0, 0.0), 2.0)
        t = times(100)
        found = frames(100, x=[x(s) for s in t], health=(t < 3.3) | (t > 6.2))
        verdict = judged(found, truth(10, x=x))
        row = judge.summary(verdict)
        self.assertAlmostEqual(row["notice_s"], 0.35, delta=0.011)
        self.assertAlmostEqual(row["back_s"], 1.25, delta=0.011)
        self.assertEqual(row["could"], 90 - 20)
        self.assertAlmostEqual(row["avail_%"], 100 * (70 - np.count_nonzero((t > 5) & (t < 6.2))) / 70)
        found["health"] = (t < 3.3).astype(float)
        self.assertEqual(judge.summary(judged(found, truth(10, x=x)))["back_s"], math.inf)


class Covariance(unittest.TestCase):
    def test_nees_of_known_value(self):
        # diag: (0.01 / 0.01)^2 + (0.03 / 0.02)^2 = 1 + 2.25
        found = frames(10, x=0.03, yaw=math.degrees(0.01), **covariance(10, c_rz_rz=1e-4, c_x_x=4e-4))
        verdict = judged(found, truth(1))
        np.testing.assert_allclose(verdict.nees, 3.25, rtol=1e-9)
        row = judge.summary(verdict)
        self.assertAlmostEqual(row["nees"], 3.25)
        self.assertAlmostEqual(row["band_%"], 100.0)

    def test_the_upper_triangle_is_both_triangles(self):
        # Of [[a, b], [b, c]] the inverse is [[c, -b], [-b, a]] / (a c - b b); rotation and translation correlate.
        a, b, c, w, x = 4e-4, 3e-4, 9e-4, 0.02, -0.01
        found = frames(4, x=x, yaw=math.degrees(w), **covariance(4, c_rz_rz=a, c_rz_x=b, c_x_x=c))
        expected = (c * w * w - 2 * b * w * x + a * x * x) / (a * c - b * b)
        np.testing.assert_allclose(judged(found, truth(1)).nees, expected)

    def test_the_band_is_that_of_chi_square_with_six_degrees_of_freedom(self):
        # P(chi2_6 < q) = 1 - exp(-q/2) (1 + q/2 + q^2/8)
        for quantile, p in zip(judge.NEES_BAND, (0.025, 0.975)):
            q = quantile / 2
            self.assertAlmostEqual(1 - math.exp(-q) * (1 + q + q * q / 2), p, delta=2e-4)

    def test_frames_without_covariance_or_health_do_not_count(self):
        columns = covariance(10, c_x_x=1e-4)
        for values in columns.values():
            values[:4] = math.nan
        found = frames(10, x=0.02, health=np.arange(10) < 8, **columns)
        verdict = judged(found, truth(1))
        self.assertEqual(np.count_nonzero(np.isnan(verdict.nees)), 4)
        self.assertAlmostEqual(judge.summary(verdict)["nees"], 4.0)

    def test_a_singular_covariance_is_infinitely_sure(self):
        verdict = judged(frames(4, x=0.01, **covariance(4, c_x_x=0.0)), truth(1))
        self.assertTrue(np.all(np.isinf(verdict.nees)))


class Bend(unittest.TestCase):
    def test_error_of_the_last_estimate(self):
        bend = np.linspace(0.0, 0.05, 20)
        bend[-3:] = math.nan
        row = judge.summary(judged(frames(20, bend=bend), truth(2, bend=lambda s: 0.1 * s)))
        self.assertAlmostEqual(row["bend_mm"], 1e3 * abs(0.05 * 16 / 19 - 0.1 * times(20)[16]))
        self.assertIsNone(judge.summary(judged(frames(20, bend=0.1), truth(2)))["bend_mm"])


class Blind(unittest.TestCase):
    def test_a_blind_spell_is_no_time_to_be_healthy_and_has_to_be_noticed(self):
        t = times(30)
        counts = np.where((t > 1.5) & (t < 2.5), 60.0, 8000.0)
        returns = {"t_ns": BEGAN + np.round(t * 1e9).astype(np.int64), "returns": counts}
        row = judge.summary(judged(frames(30, health=(t < 1.7) | (t > 2.7)), truth(3), returns=returns))
        self.assertEqual(row["could"], 30 - 10 - 10)
        self.assertAlmostEqual(row["avail_%"], 80.0)  # 2.55 and 2.65 s of 1.05 to 1.45 and 2.55 to 2.95 s
        self.assertAlmostEqual(row["notice_s"], 0.25, delta=0.011)
        self.assertAlmostEqual(row["back_s"], 0.25, delta=0.011)


class Joined(unittest.TestCase):
    def test_runs_add_up(self):
        one = judged(frames(20, x=0.003), truth(2))
        other = judged(frames(40, x=np.where(np.arange(40) == 30, 0.06, 0.004)), truth(4))
        row = judge.summary(judge.Verdict.join([one, other]))
        self.assertEqual((row["frames"], row["false"]), (60, 1))
        self.assertAlmostEqual(row["rms_mm"], math.sqrt((20 * 9 + 39 * 16 + 3600) / 60))


if __name__ == "__main__":
    unittest.main()
