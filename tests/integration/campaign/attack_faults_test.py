"""scripts/attack_faults.py: what each attack makes of the PLC's values, the configuration and the maps."""
import pathlib
import re
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import attack_faults as faults  # noqa: E402

BEGAN = 1_767_251_400_000_000_000
CONFIG = """[[lidar]]
mount = { xyz = [18.400, 1.900, -1.600], rpy_deg = [0.000, 105.000, -30.000] }
"""
ATTACKS = {attack.name: attack for attack in faults.all_attacks()}


def pcd(xyz):
    return b"VERSION 0.7\nFIELDS x y z\nVIEWPOINT 0 0 0 1 0 0 0\nDATA binary\n" + np.array(xyz, "<f4").tobytes()


MAPS = {"hull.pcd": pcd([[1, 2, 3], [-1, 4, 5]]), "quay.pcd": pcd([[10, -2, 0], [20, -4, 0]])}


def site(seconds=30.0):
    t = np.arange(0, seconds, 0.02)
    moves = np.maximum(0.0, t - 10.0)
    return faults.Site(plc={"t_ns": BEGAN + np.round(t * 1e9).astype(np.int64), "d_x": 5.0 + 0.4 * moves,
                            "theta_r": 90.0 + moves, "theta_p": 1.0 + 0.3 * moves,
                            "heartbeat": np.arange(len(t), dtype=float), "command": np.zeros(len(t))},
                       config=CONFIG, maps={}, read_map=MAPS.get)


class Values(unittest.TestCase):
    def attacked(self, name):
        true, false = site(), site()
        begin = ATTACKS[name].falsify(false)
        return true.plc, false.plc, (begin - BEGAN) * 1e-9

    def test_only_the_joint_of_its_name_is_touched_and_the_heart_beats_on(self):
        for name, attack in ATTACKS.items():
            if name.split("-")[0] not in faults.JOINTS or name.endswith("-gap"):
                continue
            true, false, _ = self.attacked(name)
            touched = [column for column in true if not np.array_equal(true[column], false[column])]
            self.assertEqual(touched, [faults.JOINTS[attack.joints[0]]], name)

    def test_sign_mirror_bias_scale_and_gain(self):
        for name, law in {"slew-sign": lambda v: -v, "travel-mirrored": lambda v: 10.0 - v,
                          "luff-bias+2": lambda v: v + 2.0, "travel-scale+5": lambda v: 1.05 * v,
                          "slew-gain+2": lambda v: 90.0 + 1.02 * (v - 90.0)}.items():
            true, false, begin = self.attacked(name)
            column = faults.JOINTS[ATTACKS[name].joints[0]]
            np.testing.assert_allclose(false[column], law(true[column]), atol=1e-9)
            self.assertEqual(begin, 0.0)

    def test_a_frozen_joint_stood_still_while_it_moved_and_is_right_again_afterwards(self):
        true, false, begin = self.attacked("travel-frozen-5")
        self.assertTrue(9.0 < begin < 11.0, begin)
        t = (true["t_ns"] - BEGAN) * 1e-9
        frozen = (t >= begin) & (t < begin + 5.0)
        self.assertEqual(len(set(false["d_x"][frozen])), 1)
        np.testing.assert_array_equal(false["d_x"][~frozen], true["d_x"][~frozen])
        for_good = self.attacked("travel-frozen")[1]
        self.assertEqual(len(set(for_good["d_x"][t >= begin])), 1)

    def test_a_joint_that_never_moves_cannot_freeze(self):
        resting = site(9.0)
        with self.assertRaises(faults.NotApplicable):
            ATTACKS["slew-frozen"].falsify(resting)

    def test_late_values_are_those_of_before(self):
        true, false, _ = self.attacked("all-late-100")
        np.testing.assert_allclose(false["theta_r"][5:], true["theta_r"][:-5], atol=1e-9)

    def test_a_drift_ends_at_its_amount_and_a_ripple_stays_within_it(self):
        true, false, begin = self.attacked("slew-drift")
        error = false["theta_r"] - true["theta_r"]
        self.assertEqual(begin, 8.0)
        self.assertEqual(np.max(np.abs(error[:400])), 0.0)
        self.assertAlmostEqual(error[-1], 0.3)
        true, false, _ = self.attacked("slew-ripple")
        self.assertAlmostEqual(np.max(np.abs(false["theta_r"] - true["theta_r"])), 0.2, delta=0.001)

    def test_after_a_gap_the_value_is_another(self):
        true, false, begin = self.attacked("travel-gap")
        t = (false["t_ns"] - BEGAN) * 1e-9
        self.assertFalse(np.any((t >= 8.0) & (t < 10.0)))
        self.assertEqual(begin, 10.0)
        np.testing.assert_allclose(false["d_x"][t >= begin], np.interp(t[t >= begin], (true["t_ns"] - BEGAN) * 1e-9,
                                                                       true["d_x"]) + 3.0)

    def test_words_of_a_float_are_swapped_or_torn(self):
        self.assertEqual(faults.words(1.0), (0x3F80, 0x0000))
        self.assertEqual(faults.from_words(*faults.words(0.1)), np.float32(0.1))
        _, false, _ = self.attacked("words-swapped")
        self.assertTrue(np.all(np.isfinite(false["d_x"])))
        true, false, _ = self.attacked("words-torn")
        torn = np.abs(false["theta_r"] - true["theta_r"]) > 1e-5
        self.assertTrue(5 < np.count_nonzero(torn) < 150, np.count_nonzero(torn))


class Mounts(unittest.TestCase):
    def mount(self, name):
        falsified = site()
        ATTACKS[name].falsify(falsified)
        return [float(n) for n in re.findall(r"-?\d+\.\d+", falsified.config)]

    def test_mounts(self):
        self.assertEqual(self.mount("mount-mirrored"), [18.4, -1.9, -1.6, 0.0, 105.0, 30.0])
        self.assertEqual(self.mount("mount-yaw90"), [18.4, 1.9, -1.6, 0.0, 105.0, 60.0])
        self.assertEqual(self.mount("mount-z0.3"), [18.4, 1.9, -1.3, 0.0, 105.0, -30.0])

    def test_a_configuration_without_a_mount_is_told(self):
        falsified = site()
        falsified.config = ""
        with self.assertRaises(ValueError):
            ATTACKS["mount-roll2"].falsify(falsified)


class Maps(unittest.TestCase):
    def points(self, name, file):
        falsified = site()
        ATTACKS[name].falsify(falsified)
        self.assertEqual(list(falsified.maps), [file])
        return faults.header_and_points(falsified.maps[file])[1]

    def test_maps(self):
        np.testing.assert_allclose(self.points("hull-map-centimetres", "hull.pcd"), [[100, 200, 300], [-100, 400, 500]])
        np.testing.assert_allclose(self.points("quay-map-moved", "quay.pcd"), [[10.4, -2, 0], [20.4, -4, 0]])
        np.testing.assert_allclose(self.points("hull-map-turned", "hull.pcd"), [[-1, 4, 3], [1, 2, 5]], atol=1e-5)
        np.testing.assert_allclose(self.points("quay-map-other", "quay.pcd"), [[1, 2, 3], [-1, 4, 5]])
        falsified = site()
        ATTACKS["hull-map-viewpoint"].falsify(falsified)
        self.assertIn(b"\nVIEWPOINT 0 5 0 1 0 0 0\n", falsified.maps["hull.pcd"])


class Contracts(unittest.TestCase):
    def test_what_shows_at_once(self):
        at_once = {name for name, attack in ATTACKS.items() if attack.at_once and not attack.quay_map_only}
        self.assertEqual(at_once, {"honest", "travel-gap", "slew-gap", "luff-gap", "words-swapped", "words-torn",
                                   "mount-mirrored", "mount-yaw90", "hull-map-centimetres", "hull-map-viewpoint",
                                   "hull-map-turned"})
        for name, attack in ATTACKS.items():
            self.assertFalse(attack.at_once and attack.joints, name)

    def test_names_are_unique(self):
        names = [attack.name for attack in faults.all_attacks()]
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main()
