"""`hulltrackd --check-config` with maps that are small, odd or no hulls: an answer in words, never a signal, and
memory in proportion to the points."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)

CONFIG = """[plc]
host = "127.0.0.1"
[[lidar]]
model = "velodyne_vlp16"
[hull]
map = "map.pcd"
"""


def grid(count, step):
    return [round(i * step, 3) for i in range(count)]


def deck(step=0.5, x0=0.0):
    return [(x0 + x, y, 0.0) for x in grid(round(30 / step), step) for y in grid(round(10 / step), step)]


def open_box(side=1.25, step=0.125, height=3.0):
    """Four walls about a floor."""
    n = round(side / step) + 1
    floor = [(x, y, 0.0) for x in grid(n, step) for y in grid(n, step)]
    rim = [(x, y, z) for z in (1.0, 2.0, height) for t in grid(n, step)
           for x, y in ((t, 0.0), (t, side), (0.0, t), (side, t))]
    return floor + rim


class MapCheck(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        self.config = self.folder / "site.toml"
        self.config.write_text(CONFIG, encoding="utf-8")

    def write_map(self, points, viewpoint="0 0 0 1 0 0 0"):
        lines = ["VERSION 0.7", "FIELDS x y z", "SIZE 4 4 4", "TYPE F F F", "COUNT 1 1 1", f"WIDTH {len(points)}",
                 "HEIGHT 1", f"VIEWPOINT {viewpoint}", f"POINTS {len(points)}", "DATA ascii"]
        lines += [f"{x:.3f} {y:.3f} {z:.3f}" for x, y, z in points]
        (self.folder / "map.pcd").write_text("\n".join(lines) + "\n", encoding="utf-8")

    def add_to_hull(self, line):
        self.config.write_text(CONFIG + line + "\n", encoding="utf-8")

    def check(self):
        """Exit code, the lines that were printed, and the most memory that the process had, MB."""
        process = subprocess.Popen([PROGRAM, "--config", str(self.config), "--check-config"], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        output = process.stdout.read()
        process.stdout.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertIn(process.returncode, (0, 78), output)
        return process.returncode, output.splitlines(), usage.ru_maxrss / 1024

    def expect(self, code, *words):
        got, lines, megabytes = self.check()
        self.assertEqual(got, code, lines)
        for word in words:
            self.assertTrue(any(word in line for line in lines), (word, lines))
        return lines, megabytes

    def test_a_small_pit_at_the_maps_edge_is_a_map(self):
        for side in (1.0, 1.25, 1.5):
            for before in (0.0, 0.25, 0.5):
                with self.subTest(f"{side} m, {before} m from the edge"):
                    self.write_map([(x + before, y, z) for x, y, z in open_box(side)] + [(0.0, 0.0, 0.0)])
                    self.check()

    def test_a_length_that_rounds_to_either_side_is_a_map(self):
        for length in (16.0, 32.0, 47.5):
            for x0 in (-59.51, -27.13, 3.37, 1001.01):
                deck_points = [(x0 + x, y, z) for x in (0.0, length) for y in grid(20, 0.5) for z in grid(8, 0.5)]
                self.write_map(deck_points)
                self.check()

    def test_a_point_far_away_is_left_out_and_told(self):
        for far in (1400.0, 7000.0, 9999.0):
            self.write_map(deck(0.25) + [(far, 0.0, 0.0)])
            lines, megabytes = self.expect(0, "good", f"1 of its 4801 points lie {far - 29.75:.0f} to ", "left out")
            self.assertLess(megabytes, 600, lines)

    def test_points_strewn_over_kilometres_are_refused_at_once(self):
        self.write_map([(x - 9000, y - 7500, 0.0) for x in grid(60, 300) for y in grid(50, 300)])
        lines, megabytes = self.expect(78, "site.toml:", "no hull is longer than 500 m")
        self.assertLess(megabytes, 600, lines)

    def test_points_lie_where_the_viewpoint_puts_them_and_that_is_told(self):
        self.write_map(deck(0.25), "0.4 0 0 1 0 0 0")
        self.expect(0, "site.toml:6: hull.map: warning: ", "its VIEWPOINT shifts the points by 0.400, 0.000, 0.000 m")
        self.write_map(deck(0.25), "0.4 0 0 1 0 0")
        self.expect(78, "map.pcd: line 8: VIEWPOINT must be seven finite numbers")
        # 40 m aside by the file's own words: no longer near the reference point.
        self.write_map(deck(0.25), "0 40 0 1 0 0 0")
        self.expect(78, "hull.reference_point: lies 40.0 m from the nearest point of the map")

    def test_what_is_no_hull_is_told_with_figures(self):
        self.write_map([(1.0, 2.0, 3.0)] * 1000)
        self.expect(78, "hull.map: ", "all of its 1000 points lie in 1 cubes")
        self.write_map([(0.05 * i, 0.0, 0.0) for i in range(1000)])
        self.expect(0, "hull.map: warning: ", "only 0 of its")
        self.write_map([(100 * x, 100 * y, z) for x, y, z in deck()])
        self.expect(78, "extends 2950 m along X, and no hull is longer than 500 m; in centimetres it would be 30 m")

    def test_keys_that_do_not_go_with_the_map_are_told_at_their_line(self):
        self.write_map(deck(0.25))
        self.add_to_hull("reference_point = [900.0, 0.0, 0.0]")
        self.expect(78, "site.toml:7: hull.reference_point: lies 870.2 m from the nearest point")
        self.add_to_hull("region = [1000.0, -50.0, -50.0, 1100.0, 50.0, 50.0]")
        self.expect(78, "site.toml:7: hull.region: no point of the map can come nearer")
        self.add_to_hull("envelope = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]")
        self.expect(78, "site.toml:7: hull.envelope: is 0.000 m wide along X", "along Y", "along Z")
        self.add_to_hull("envelope = [1.0, -2.0, -9.0, 15.0, 2.0, 3.0]")
        self.expect(0, "site.toml:7: hull.envelope: warning: leaves out 0, 0, 0")


unittest.main()
