"""Two sensors of one model on one port and no `source`: named, fault bit 4, no health, never mixed."""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HULLTRACK = pathlib.Path(sys.argv.pop(1))
FOREIGN = 1 << 4


def run(*arguments):
    done = subprocess.run([HULLTRACK, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stderr


class OnePort(unittest.TestCase):
    def test_both_are_named_and_no_frame_is_healthy(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            model = ["--lidar", "velodyne_vlp16"]
            run("simulate", "--scenario", "static", "--frames", 25, "--seed", 5, *model, *model, "--out", folder)
            config = folder / "hulltrackd.toml"
            first, *_ = re.split(r"(?=\[\[lidar\]\])", config.read_text())[1:]
            head = re.split(r"(?=\[\[lidar\]\])", config.read_text())[0]
            tail = re.split(r"(?=^\[hull)", config.read_text(), flags=re.M)[1:]
            first = re.split(r"(?=^\[hull)", first, flags=re.M)[0]
            config.write_text(head + re.sub(r"(?m)^source = .*\n", "", first) + "".join(tail))
            summary = run("replay", folder, "--csv", folder / "frames.csv")
            with open(folder / "frames.csv", newline="") as stream:
                frames = list(csv.DictReader(stream))
        self.assertGreater(len(frames), 20)
        self.assertIn("two sensors send to UDP port 2368: 192.168.1.201 and 192.168.1.202; set `source`", summary)
        for frame in frames:
            self.assertEqual(frame["health"], "0")
            self.assertTrue(int(frame["faults"]) & FOREIGN, frame["frame"])
        self.assertEqual(frames[-1]["matched"] == "0", False, "what the first one sees is still registered")


if __name__ == "__main__":
    unittest.main()
