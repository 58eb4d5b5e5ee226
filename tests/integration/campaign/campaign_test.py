"""scripts/campaign around a `hulltrack` that only writes tables: what it calls, prints, keeps and returns.

The stand-in tracks exactly, but for the scenario, seed and method that a test tells it to get wrong."""
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

CAMPAIGN = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "campaign"
TOOL = r'''#!/usr/bin/python3
import os, pathlib, sys, time
BEGAN = 1_767_251_400_000_000_000
def option(name):
    return sys.argv[sys.argv.index(name) + 1]
with open(os.environ["LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\n")
if "--list" in sys.argv:
    print("name,frames,mapped_ship,clear\ncalm,30,1,1\ngale,50,1,0\nother,30,0,0")
elif sys.argv[1] == "simulate":
    if os.environ.get("SLEEP") == option("--scenario"):
        time.sleep(600)
    if os.environ.get("FAIL") == option("--scenario"):
        sys.exit("no such ship")
    folder, count = pathlib.Path(option("--out")), int(option("--frames"))
    (folder / "hulltrackd.toml").write_text("[tracking]\nmethod = \"auto\"\n[hull]\nmax_speed = 0.3\n")
    (folder / "name").write_text(option("--scenario") + option("--seed"))
    with open(folder / "truth.csv", "w") as truth:
        truth.write("t_ns,x,y,z,roll,pitch,yaw\n")
        truth.writelines(f"{BEGAN + 10_000_000 * i},0.25,0,0,0,0,0\n" for i in range(-50, 10 * count + 50))
    with open(folder / "returns.csv", "w") as returns:
        returns.write("t_ns,returns\n")
        returns.writelines(f"{BEGAN + 100_000_000 * i + 50_000_000},9000\n" for i in range(count))
elif sys.argv[1] == "replay":
    folder, config = pathlib.Path(sys.argv[2]), pathlib.Path(option("--config")).read_text()
    name = (folder / "name").read_text()
    count = (len((folder / "truth.csv").read_text().splitlines()) - 101) // 10
    wrong = os.environ.get("WRONG", "").split(",") == [name, config.split('method = "')[1].split('"')[0]]
    with open(option("--csv"), "w") as table:
        table.write("t_ns,health,x,y,z,roll,pitch,yaw,ms\n")
        for i in range(count):
            x = 0.25 + (0.06 if wrong and i == 20 else 0.002)
            health = 0 if name.startswith("other") else 1
            table.write(f"{BEGAN + 100_000_000 * i + 50_000_000},{health},{x},0,0,0,0,0,1.5\n")
'''


class Campaign(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.scratch = self.folder / "scratch"
        tool = self.folder / "build" / "daemon" / "hulltrack"
        tool.parent.mkdir(parents=True)
        self.scratch.mkdir()
        tool.write_text(TOOL)
        tool.chmod(0o755)
        self.log = self.folder / "log"

    def environment(self, **more):
        return {**os.environ, "TMPDIR": str(self.scratch), "LOG": str(self.log), "PYTHONDONTWRITEBYTECODE": "1",
                **more}

    def run_campaign(self, *arguments, **environment):
        command = [CAMPAIGN, "--build", self.folder / "build", "--csv", self.folder / "table.csv", *arguments]
        done = subprocess.run(command, env=self.environment(**environment), capture_output=True, text=True)
        with open(self.folder / "table.csv", newline="") as stream:
            rows = {(row["scenario"], row["method"]): row for row in csv.DictReader(stream)}
        return done, rows

    def calls(self):
        return self.log.read_text().splitlines()

    def test_every_scenario_seed_and_method_is_in_the_table(self):
        done, rows = self.run_campaign("--seeds", "3")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len([c for c in self.calls() if "--out" in c]), 3 * 3)
        self.assertEqual(len([c for c in self.calls() if c.startswith("replay")]), 3 * 3 * 2)
        for method in ("auto", "point_to_point"):
            self.assertEqual(rows["calm", method]["frames"], "90")
            self.assertEqual(rows["all", method]["frames"], str(3 * (30 + 50 + 30)))
            self.assertEqual(rows["all clear", method]["frames"], "90")
            self.assertAlmostEqual(float(rows["gale", method]["rms_mm"]), 2.0)
            self.assertEqual(rows["other", method]["could"], "0")
        self.assertIn("auto: 0 false healthy frames among 240 healthy ones of 330 frames", done.stdout)
        self.assertEqual(list(self.scratch.iterdir()), [])

    def test_the_methods_stand_side_by_side_with_the_error_of_every_pose(self):
        done, rows = self.run_campaign("--seeds", "1", WRONG="gale1,point_to_point")
        self.assertAlmostEqual(float(rows["gale", "point_to_point"]["off_%"]), 2.0)
        self.assertAlmostEqual(float(rows["gale", "auto"]["off_%"]), 0.0)
        table = done.stdout[done.stdout.index("Error of every"):].split("\n\n")[1]
        above, header, *lines = table.splitlines()
        figures = ["no_pose_%", "off_%", "p50_m", "p95_m", "p50_deg", "p95_deg"]
        self.assertEqual(header.split(), ["scenario", "there", *figures, *figures])
        # Each method's name begins where its columns do.
        self.assertEqual([above.index("auto"), above.index("point_to_point")],
                         [header.index("no_pose_%"), header.rindex("no_pose_%")])
        exact = ["0.0", "0.0", "0.002", "0.002", "0.000", "0.000"]
        self.assertEqual(lines[0].split(), ["calm", "30", *exact, *exact])
        self.assertEqual(lines[1].split(), ["gale", "50", *exact, "0.0", "2.0", *exact[2:]])
        self.assertEqual([line.split()[0] for line in lines[2:]], ["all", "all"])  # another ship is not there

    def test_a_false_healthy_frame_of_the_first_method_fails_the_campaign(self):
        done, rows = self.run_campaign("--seeds", "2", WRONG="gale2,auto")
        self.assertEqual(done.returncode, 1)
        self.assertEqual([rows[s, "auto"]["false"] for s in ("calm", "gale", "other", "all")], ["0", "1", "0", "1"])
        self.assertEqual(rows["all", "point_to_point"]["false"], "0")

    def test_one_of_another_method_does_not(self):
        done, rows = self.run_campaign("--seeds", "2", WRONG="gale2,point_to_point")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(rows["all", "point_to_point"]["false"], "1")

    def test_kept_recordings_are_used_again_and_long_ones_are_cut(self):
        kept = self.folder / "kept"
        arguments = ["--seeds", "1", "--scenarios", "gale", "--frames", "20", "--keep", kept, "--methods", "auto"]
        self.run_campaign(*arguments)
        first = self.log.read_text()
        self.log.unlink()
        done, rows = self.run_campaign(*arguments, "--markdown")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse([c for c in self.calls() if "--out" in c])
        self.assertEqual(rows["gale", "auto"]["frames"], "20")
        self.assertIn("| scenario | there | auto no_pose_% | auto off_% |", done.stdout)
        self.assertIn("| gale | auto | 20 |", done.stdout)
        self.assertIn("--returns strongest", first)
        self.assertEqual([f.name for f in sorted(next(kept.iterdir()).glob("auto.*"))], ["auto.csv", "auto.toml"])

    def test_a_run_that_fails_is_told_and_the_others_go_on(self):
        done, rows = self.run_campaign("--seeds", "1", FAIL="gale")
        self.assertEqual(done.returncode, 1)
        self.assertIn("gale seed 1", done.stderr)
        self.assertIn("no such ship", done.stderr)
        self.assertIn(("calm", "auto"), rows)
        self.assertEqual(list(self.scratch.iterdir()), [])

    def test_half_a_recording_is_not_kept(self):
        kept = self.folder / "kept"
        self.run_campaign("--seeds", "1", "--keep", kept, "--returns", "dual", FAIL="gale")
        self.assertEqual(sorted(f.name.split("-")[0] for f in kept.iterdir()), ["calm", "other"])
        self.assertEqual({f.name.split("-")[2] for f in kept.iterdir()}, {"dual"})

    def test_an_interrupt_ends_the_children_and_leaves_nothing(self):
        command = [CAMPAIGN, "--build", self.folder / "build", "--seeds", "1", "--jobs", "2"]
        campaign = subprocess.Popen(command, env=self.environment(SLEEP="gale"), stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE, text=True)
        for line in campaign.stderr:  # the others are done, gale sleeps
            if "other seed 1" in line:
                break
        campaign.send_signal(signal.SIGINT)
        output, _ = campaign.communicate()
        self.assertEqual(campaign.returncode, 1)
        self.assertIn("calm", output)
        self.assertNotIn("gale", output)
        self.assertEqual(list(self.scratch.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
