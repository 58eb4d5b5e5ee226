"""scripts/attack around a `hulltrack` that only writes tables: what it falsifies, prints, keeps and returns.

The stand-in believes the travel: what is wrong with it is wrong in its pose. With a map of the quay it sees 5 cm of
that after a second, unless a test makes it blind."""
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

ATTACK = pathlib.Path(__file__).resolve().parents[3] / "scripts" / "attack"
TOOL = r'''#!/usr/bin/python3
import bisect, csv, os, pathlib, sys, time, tomllib
BEGAN = 1_767_251_400_000_000_000
def option(name):
    return sys.argv[sys.argv.index(name) + 1]
def travel(s):
    return 0.4 * max(0.0, s - 1.0)
with open(os.environ["LOG"], "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\n")
if "--list" in sys.argv:
    print("name,frames,mapped_ship,clear\nstatic,30,1,1\nmooring,50,1,0\nother,30,0,0")
elif sys.argv[1] == "simulate":
    folder, count = pathlib.Path(option("--out")), int(option("--frames"))
    (folder / "hulltrackd.toml").write_text("""[machine]
slew = { xyz = [0.0, -8.0, 17.0], rpy_deg = [0.0, 0.0, 0.0] }
luff = { xyz = [2.0, 0.0, 3.5], rpy_deg = [0.0, 0.0, 0.0] }
[[lidar]]
mount = { xyz = [18.400, 1.900, -1.600], rpy_deg = [0.000, 105.000, -30.000] }
[hull]
map = "hull.pcd"
reference_point = [0.0, 4.0, 3.0]

# [quay]   # what stands still
# height = -0.150
# map = "quay.pcd"
""")
    for name in ("hull.pcd", "quay.pcd"):
        (folder / name).write_bytes(b"VIEWPOINT 0 0 0 1 0 0 0\nDATA binary\n" + 12 * b"\0")
    with open(folder / "truth.csv", "w") as truth:
        truth.write("t_ns,x,y,z,roll,pitch,yaw\n")
        truth.writelines(f"{BEGAN + 10_000_000 * i},0.25,0,0,0,0,0\n" for i in range(-50, 10 * count + 50))
    with open(folder / "plc.csv", "w") as plc:
        plc.write("t_ns,d_x,theta_r,theta_p,heartbeat,command\n")
        plc.writelines(f"{BEGAN + 20_000_000 * i},{travel(0.02 * i)},90.0,1.0,{i % 60000},0\n"
                       for i in range(-25, 5 * count + 25))
    (folder / "returns.csv").write_text("t_ns,returns\n")
elif sys.argv[1] == "replay":
    if os.environ.get("SLEEP") and "quay" not in tomllib.loads(pathlib.Path(option("--config")).read_text()):
        time.sleep(600)
    folder = pathlib.Path(sys.argv[2])
    config = tomllib.loads(pathlib.Path(option("--config")).read_text())
    if b"VIEWPOINT 0 5" in (folder / "hull.pcd").read_bytes():
        sys.exit("hull.pcd: has a VIEWPOINT")
    if os.environ.get("CRASH"):
        os.kill(os.getpid(), 11)
    sees = "map" in config.get("quay", {}) and not os.environ.get("BLIND")
    rows = [(int(r["t_ns"]), float(r["d_x"])) for r in csv.DictReader(open(folder / "plc.csv"))]
    if "--joints" in sys.argv:
        with open(option("--joints"), "w") as table:
            table.write(",".join(["frame,t_ns"] + [f"{j}_off,{j}_hidden,{j}_far" for j in ("travel", "slew", "luff")]))
            table.write("\n")
            table.writelines(f"{i},{BEGAN + 100_000_000 * i + 50_000_000},"
                             f"{',,0' if 'NO_VIEW' in os.environ else '0,0.1,1'},0,0.3,1,,,0\n" for i in range(120))
        sys.exit()
    count = (len((folder / "truth.csv").read_text().splitlines()) - 101) // 10
    with open(option("--csv"), "w") as table:
        table.write("t_ns,health,faults,x,y,z,roll,pitch,yaw,ms,reason\n")
        for i in range(count):
            t_ns = BEGAN + 100_000_000 * i + 50_000_000
            d_x = rows[bisect.bisect(rows, (t_ns,)) - 1][1]
            off = d_x - travel((t_ns - BEGAN) * 1e-9)
            seen = sees and abs(off) > 0.05 and i > 10
            accused = seen or "ACCUSE" in os.environ
            table.write(f"{t_ns},{0 if seen else 1},{4 if accused else 0},{0.25 + off},0,0,0,0,0,1.5,"
                        f"{'the travel contradicts the quay' if seen else ''}\n")
'''


class Attack(unittest.TestCase):
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

    def run_attack(self, *arguments, **environment):
        command = [ATTACK, "--build", self.folder / "build", "--csv", self.folder / "table.csv", "--frames", "120",
                   *arguments]
        done = subprocess.run(command, env=self.environment(**environment), capture_output=True, text=True)
        rows = {}
        if (self.folder / "table.csv").exists():
            with open(self.folder / "table.csv", newline="") as stream:
                rows = {(row["attack"], row["quay"], row["scenario"], row["seed"]): row
                        for row in csv.DictReader(stream)}
        return done, rows

    def calls(self, what):
        return [line for line in self.log.read_text().splitlines() if line.startswith(what)]

    def test_one_recording_serves_every_attack_with_and_without_a_map_of_the_quay(self):
        done, rows = self.run_attack("--attacks", "honest,travel-bias+1", "--seeds", "2")
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        self.assertEqual(len(self.calls("simulate --scenario")), 2 * 2)  # static and mooring; other is not for this
        self.assertEqual(len(self.calls("replay")), 2 * 2 * (1 + 2 * 2))  # a look at the quay, attacks, maps
        seen, unseen = (rows["travel-bias+1", way, "mooring", "2"] for way in ("map", "none"))
        self.assertEqual((seen["late"], seen["bit"], seen["named"]), ("0", "True", "True"))
        self.assertEqual((unseen["wrong"], unseen["late"], unseen["shows_s"]), ("120", "0", "inf"))
        self.assertAlmostEqual(float(unseen["worst_m"]), 1.0, places=6)
        self.assertEqual(rows["honest", "map", "static", "1"]["wrong"], "0")
        self.assertIn("0 wrong healthy frames after the fault has shown", done.stdout)
        self.assertEqual(list(self.scratch.iterdir()), [])

    def test_a_wrong_healthy_frame_after_the_fault_has_shown_fails_and_is_told(self):
        done, rows = self.run_attack("--attacks", "travel-bias+1", "--scenarios", "static", BLIND="1")
        self.assertEqual(done.returncode, 1)
        # It shows at once; three seconds later it is late: 3.05 s to 11.95 s.
        self.assertEqual(rows["travel-bias+1", "map", "static", "1"]["late"], "90")
        self.assertIn("travel-bias+1 in static seed 1, quay:map: 90 wrong frames with health 1", done.stdout)
        self.assertIn("90 wrong healthy frames after the fault has shown", done.stdout)

    def test_a_machine_worn_within_its_class_must_not_be_accused(self):
        done, rows = self.run_attack("--attacks", "worn-1", "--scenarios", "static", ACCUSE="1")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(rows["worn-1", "map", "static", "1"]["charged"], "120")
        self.assertIn("worn-1 in static seed 1, quay:map: accused in 120 frames, and is within its class", done.stdout)

    def test_a_map_of_the_quay_that_shows_too_little_is_told(self):
        done, _ = self.run_attack("--attacks", "travel-bias+1", "--scenarios", "static", NO_VIEW="1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("travel: of 90 frames in which it was off by more than wear hides the map of the quay showed that "
                      "in 0 only", done.stdout)

    def test_recordings_share_the_attacks(self):
        done, rows = self.run_attack("--attacks", "honest,travel-bias*", "--seeds", "2", "--quay", "map", "--share", "5")
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        self.assertEqual({attack: [key[2:] for key in rows if key[0] == attack] for attack, *_ in rows},
                         {"honest": [("static", "1")], "travel-bias+0.2": [("static", "2")],
                          "travel-bias+0.5": [("mooring", "1")], "travel-bias+1": [("mooring", "2")]})

    def test_a_map_that_the_tool_refuses_is_no_wrong_pose_and_a_crash_is_a_failure(self):
        done, rows = self.run_attack("--attacks", "hull-map-viewpoint", "--scenarios", "static")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(rows["hull-map-viewpoint", "map", "static", "1"]["refused"], "True")
        done, _ = self.run_attack("--attacks", "travel-bias+1", "--scenarios", "static", CRASH="1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("exit code -11", done.stderr)

    def test_ways_of_knowing_the_quay_stand_side_by_side(self):
        done, rows = self.run_attack("--attacks", "honest", "--scenarios", "static", "--quay", "plane,none")
        self.assertEqual({key[1] for key in rows}, {"plane", "none"})
        above = done.stdout.splitlines()[0].split()
        self.assertEqual(above, ["quay:plane", "quay:none"])

    def test_recordings_and_tables_are_kept_and_used_again(self):
        kept = self.folder / "kept"
        for _ in range(2):
            self.run_attack("--attacks", "honest", "--scenarios", "static", "--keep", kept)
        self.assertEqual(len(self.calls("simulate --scenario")), 1)
        files = {file.name for file in next(kept.iterdir()).iterdir()}
        self.assertLessEqual({"honest-map.csv", "honest-none.csv", "plc.csv"}, files)
        self.assertNotIn("attacked", files)

    def test_names_that_are_none_are_told(self):
        for arguments in (["--attacks", "earthquake"], ["--quay", "moon"], ["--scenarios", "typhoon"]):
            done, _ = self.run_attack(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn(arguments[1], done.stderr)

    def test_list_names_the_attacks(self):
        done, _ = self.run_attack("--list", "--attacks", "slew-*")
        self.assertEqual(done.returncode, 0)
        self.assertTrue(all(line.startswith("slew-") and len(line) > 30 for line in done.stdout.splitlines()))

    def test_an_interrupt_ends_the_children_tells_what_there_is_and_leaves_nothing(self):
        command = [ATTACK, "--build", self.folder / "build", "--scenarios", "static", "--attacks", "honest",
                   "--jobs", "1"]
        attack = subprocess.Popen(command, env=self.environment(SLEEP="1"), stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        for line in attack.stderr:  # with a map it is done, without it sleeps
            if "static seed 1, honest, quay:map" in line:
                break
        attack.send_signal(signal.SIGINT)
        output, _ = attack.communicate()
        self.assertEqual(attack.returncode, 1)
        self.assertIn("300 healthy ones of 300 frames", output)
        self.assertEqual(list(self.scratch.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
