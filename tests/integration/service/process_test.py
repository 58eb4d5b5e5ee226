"""hulltrackd as a process: start, stop, reload, exit codes, what the service manager and the PLC see."""
import os
import pathlib
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM, ROOM_LIDAR = sys.argv[1], sys.argv[2]
sys.path.insert(0, sys.argv[3])
from service_process import Plc, Process, Service, free_port  # noqa: E402 (path comes from the command line)

CONFIG = """
[plc]
host = "127.0.0.1"
port = {plc_port}

[[lidar]]
model = "velodyne_vlp16"
bind = "127.0.0.1"
port = {lidar_port}
mount = {{ xyz = [0.2, -0.3, 0.5], rpy_deg = [35.0, 20.0, 10.0] }}

[hull]
map = "room.pcd"
"""


def healthy(record):
    return record["health"] == 1


def full_pipe(test):
    """The writing end of a pipe without room for a byte."""
    reader, writer = os.pipe()
    test.addCleanup(os.close, reader)
    test.addCleanup(os.close, writer)
    os.set_blocking(writer, False)
    try:
        while os.write(writer, b"\n" * 4096):
            pass
    except BlockingIOError:
        os.set_blocking(writer, True)
    return writer


class ServiceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.map = pathlib.Path(cls.shared.name) / "room.pcd"
        subprocess.run([ROOM_LIDAR, "--map", cls.map], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "room.pcd").symlink_to(self.map)
        self.config = self.folder / "hulltrackd.toml"
        self.lidar_port = free_port(socket.SOCK_DGRAM)

    def write_config(self, plc_port, more=""):
        self.config.write_text(CONFIG.format(plc_port=plc_port, lidar_port=self.lidar_port) + more,
                               encoding="utf-8")

    def start(self, process):
        self.addCleanup(process.close)
        return process

    def start_all(self):
        plc = self.start(Plc())
        self.start(Process([ROOM_LIDAR, self.lidar_port]))
        self.write_config(plc.port)
        service = self.start(Service(PROGRAM, self.config, self.folder))
        service.wait_ready()
        plc.wait_for(healthy, "with health 1")
        return plc, service

    def run_to_end(self, *arguments, runtime_folder=None):
        env = dict(os.environ, RUNTIME_DIRECTORY=str(runtime_folder)) if runtime_folder else None
        return subprocess.run([PROGRAM, "--config", self.config, *arguments], capture_output=True, text=True,
                              check=False, env=env)

    def test_tracks_and_stops_with_health_0_and_state_7(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with self.subTest(number):
                plc, service = self.start_all()
                service.wait_for_notice(lambda notice: notice.startswith("STATUS=tracking"), "with the status")
                service.signal(number)
                service.wait_for_notice(lambda notice: "STOPPING=1" in notice, "STOPPING=1")
                self.assertEqual(service.wait(), 0, service.err.all)
                self.assert_told_the_end(plc)
                last = plc.writes()[-1]
                self.assertEqual(last["heartbeat"], last["heartbeat_copy"])
                service.close()
                (self.folder / "notify").unlink()
                self.lidar_port = free_port(socket.SOCK_DGRAM)

    def test_starts_and_is_ready_without_plc_and_lidar(self):
        self.write_config(free_port(socket.SOCK_STREAM))
        service = self.start(Service(PROGRAM, self.config, self.folder))
        service.wait_ready()
        status = service.wait_for_notice(lambda notice: notice.startswith("STATUS="), "with the status")
        self.assertIn("PLC down", status)
        service.err.find(lambda line: "127.0.0.1:" in line and "PLC" in line, "about the PLC")
        service.signal(signal.SIGTERM)
        self.assertEqual(service.wait(), 0)

    def test_feeds_the_watchdog_while_all_is_well(self):
        self.write_config(free_port(socket.SOCK_STREAM))
        service = self.start(Service(PROGRAM, self.config, self.folder, watchdog_usec=1000000))
        service.wait_ready()
        for _ in range(3):
            service.wait_for_notice(lambda notice: notice == "WATCHDOG=1", "WATCHDOG=1")

    def test_reload_takes_a_good_configuration_and_the_heartbeat_goes_on(self):
        plc, service = self.start_all()
        self.write_config(plc.port, "\n[health]\nrecover_frames = 3\n")
        service.signal(signal.SIGHUP)
        service.wait_for_notice(lambda notice: "RELOADING=1" in notice, "RELOADING=1")
        service.wait_ready()
        service.err.find(lambda line: "new configuration is in force" in line, "about the reload")
        plc.wait_for(lambda record: not healthy(record), "with health 0 after the reload")
        plc.wait_for(healthy, "with health 1 after the reload")
        self.assert_unbroken_heartbeat(plc)
        records = self.after_first_health(plc)
        frames = [record["frame"] for record in records]
        self.assertEqual(frames, sorted(frames))
        self.assertLess(max(record["age_ms"] for record in records), 1e7, "the pose stays through a reload")
        times = [record["mono_ns"] for record in plc.writes()]
        gap = max(b - a for a, b in zip(times, times[1:]))
        print(f"longest gap between writes, reload included: {gap * 1e-6:.0f} ms", file=sys.stderr)

    def test_reload_refuses_a_bad_configuration_and_the_old_one_stays(self):
        plc, service = self.start_all()
        good = self.config.read_text(encoding="utf-8")
        number_of_lines = len(good.splitlines())
        for bad, complaint in ((good + "nonsense = 1\n", f"hulltrackd.toml:{number_of_lines + 1}: "),
                               (good.replace("room.pcd", "absent.pcd"), "absent.pcd"),
                               (good.replace("[plc]", "[plc"), "hulltrackd.toml:2: ")):
            with self.subTest(complaint):
                self.config.write_text(bad, encoding="utf-8")
                service.signal(signal.SIGHUP)
                service.err.find(lambda line, what=complaint: what in line, f"with {complaint}")
                service.err.find(lambda line: "the old configuration stays in force" in line and "refused" in line,
                                 "about the refusal")
                plc.wait_for(healthy, "with health 1")
        # No session was started anew: the first state never comes back, and frames are counted on. (A slow machine
        # may cost health for a while, which is another matter.)
        records = self.after_first_health(plc)
        self.assertNotIn(0, [record["state"] for record in records])
        frames = [record["frame"] for record in records]
        self.assertEqual(frames, sorted(frames))
        self.assert_unbroken_heartbeat(plc)

    def test_reload_to_a_port_in_use_goes_back_to_the_old_one(self):
        plc, service = self.start_all()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", 0))
            text = self.config.read_text(encoding="utf-8")
            self.config.write_text(text.replace(str(self.lidar_port), str(taken.getsockname()[1])),
                                   encoding="utf-8")
            service.signal(signal.SIGHUP)
            service.err.find(lambda line: "in use" in line and "old configuration stays" in line, "about the port")
            plc.wait_for(healthy, "with health 1 from the old configuration")

    def test_stop_during_a_reload_that_reads_a_big_map_leaves_health_0_and_state_7(self):
        plc, service = self.start_all()
        self.write_big_map("big.pcd", 3000000)
        text = self.config.read_text(encoding="utf-8")
        self.config.write_text(text.replace("room.pcd", "big.pcd"), encoding="utf-8")
        service.signal(signal.SIGHUP)
        service.wait_for_notice(lambda notice: "RELOADING=1" in notice, "RELOADING=1")
        service.signal(signal.SIGTERM)
        self.assertEqual(service.wait(), 0, service.err.all)
        self.assert_told_the_end(plc)
        self.assertTrue(any("stopped as asked" in line for line in service.err.all), service.err.all)

    def write_big_map(self, name, points):
        """The room's points again and again, as binary PCD: what takes long to read."""
        header, body = self.map.read_bytes().split(b"DATA binary\n")
        count = int(next(line for line in header.split(b"\n") if line.startswith(b"POINTS")).split()[1])
        times = points // count
        for key in (b"WIDTH", b"POINTS"):
            header = header.replace(key + b" %d" % count, key + b" %d" % (count * times))
        (self.folder / name).write_bytes(header + b"DATA binary\n" + body * times)

    # -- files that are read by a process of their own

    def write_stuck_config(self, plc_port, more=""):
        """With a calibration that is a pipe: whoever reads it waits until somebody writes into it."""
        os.mkfifo(self.folder / "pipe")
        self.addCleanup(self.release_pipe)
        self.write_config(plc_port, more)
        text = self.config.read_text(encoding="utf-8")
        self.config.write_text(text.replace('"velodyne_vlp16"', '"hesai_xt32"\ncalibration = "pipe"'), encoding="utf-8")

    def release_pipe(self):
        try:
            os.close(os.open(self.folder / "pipe", os.O_WRONLY | os.O_NONBLOCK))
        except OSError:
            pass  # nobody reads

    def reader_at_the_pipe(self, service):
        """The process id of the reader, once it has opened the pipe."""
        pipe = os.open(self.folder / "pipe", os.O_WRONLY)  # waits for the reader
        self.addCleanup(os.close, pipe)
        children = pathlib.Path(f"/proc/{service.child.pid}/task/{service.child.pid}/children")
        return int(children.read_text(encoding="ascii").split()[0])

    def stuck_at_the_start(self):
        plc = self.start(Plc())
        self.write_stuck_config(plc.port)
        service = self.start(Service(PROGRAM, self.config, self.folder))
        return plc, service, self.reader_at_the_pipe(service)

    def stuck_in_a_reload(self):
        plc, service = self.start_all()
        self.write_stuck_config(plc.port)
        service.signal(signal.SIGHUP)
        return plc, service, self.reader_at_the_pipe(service)

    def test_the_plc_is_told_health_0_before_any_other_file_is_read(self):
        plc, service, _ = self.stuck_at_the_start()
        plc.wait_for(lambda record: record["heartbeat"] >= 10, "with the tenth heartbeat")
        self.assertEqual({(record["health"], record["state"]) for record in plc.writes()}, {(0, 0)})
        self.assert_unbroken_heartbeat(plc)
        self.assertFalse(any("READY" in notice for notice in list(service.notices.queue)))
        for told in ("EXTEND_TIMEOUT_USEC", "STATUS=starts"):
            self.assertTrue(any(told in notice for notice in list(service.notices.queue)), told)

    def test_the_first_session_goes_on_with_the_heartbeat_of_the_start(self):
        plc, _ = self.start_all()
        self.assert_unbroken_heartbeat(plc)
        times = [record["mono_ns"] for record in plc.writes()]
        gap = max(b - a for a, b in zip(times, times[1:]))
        print(f"longest gap between writes, start included: {gap * 1e-6:.0f} ms", file=sys.stderr)

    def test_stops_at_once_while_files_are_read_at_the_start_or_for_a_reload(self):
        for begin in (self.stuck_at_the_start, self.stuck_in_a_reload):
            with self.subTest(begin.__name__):
                plc, service, reader = begin()
                pidfd = os.pidfd_open(reader)
                plc.wait_for(lambda record: True, "at all")
                service.signal(signal.SIGTERM)
                self.assertEqual(service.wait(), 0, service.err.all)
                self.assert_told_the_end(plc)
                self.wait_for_end(pidfd)
                service.close()
                (self.folder / "notify").unlink()
                (self.folder / "pipe").unlink()

    def test_a_reader_that_dies_in_a_reload_costs_the_session_nothing(self):
        plc, service, reader = self.stuck_in_a_reload()
        os.kill(reader, signal.SIGSEGV)
        service.err.find(lambda line: "pipe: reading it ended the reader with signal SEGV" in line, "about the reader")
        service.err.find(lambda line: "reload refused" in line, "about the refusal")
        plc.wait_for(healthy, "with health 1")
        self.assertNotIn(0, [record["state"] for record in self.after_first_health(plc)])
        self.assert_unbroken_heartbeat(plc)

    def test_a_reader_that_dies_at_the_start_is_a_problem_of_its_file_and_told_to_the_plc(self):
        plc, service, reader = self.stuck_at_the_start()
        os.kill(reader, signal.SIGSEGV)
        self.assertEqual(service.wait(), 78)
        line = self.config.read_text(encoding="utf-8").splitlines().index('calibration = "pipe"') + 1
        self.assertIn(f"{self.config}:{line}: lidar.calibration: {self.folder}/pipe: reading it ended the reader",
                      "\n".join(service.err.all))
        self.assert_told_the_end(plc)

    def test_the_reader_never_outlives_the_service(self):
        _, service, reader = self.stuck_in_a_reload()
        pidfd = os.pidfd_open(reader)
        service.signal(signal.SIGKILL)
        self.wait_for_end(pidfd)

    def wait_for_end(self, pidfd):
        self.assertEqual(select.select([pidfd], [], [], 60)[0], [pidfd])
        os.close(pidfd)

    def test_a_configuration_with_an_error_ends_with_health_0_where_the_plc_is_known(self):
        for more, told in (("\n[tracking]\nvoxel_sise = 0.5\n", True), ("\n[plc.write]\nbasis = 300\n", False)):
            with self.subTest(more):
                plc = self.start(Plc())
                self.write_config(plc.port, more)
                self.assertEqual(self.run_to_end().returncode, 78)
                if told:
                    self.assert_told_the_end(plc)
                else:
                    self.assertEqual(plc.writes(), [])

    def test_a_plc_that_never_answers_does_not_hold_up_the_end(self):
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as silent:
            silent.bind(("127.0.0.1", 0))
            silent.listen()
            self.write_config(silent.getsockname()[1])
            text = self.config.read_text(encoding="utf-8")
            self.config.write_text(text.replace("[plc]\n", "[plc]\nresponse_timeout_ms = 5000\n"), encoding="utf-8")
            service = self.start(Service(PROGRAM, self.config, self.folder))
            service.wait_ready()
            service.signal(signal.SIGTERM)
            self.assertEqual(service.wait(), 0, service.err.all)
            self.assertTrue(any("the end took too long" in line for line in service.err.all), service.err.all)

    # -- after failures in a row

    def waiting(self, plc):
        """A service that has failed so often that it waits for a minute."""
        (self.folder / "failures").write_text("9\n", encoding="ascii")
        (self.folder / "last-end").write_text("signal killed SEGV\n", encoding="ascii")
        self.write_config(plc.port)
        service = self.start(Service(PROGRAM, self.config, self.folder, runtime_folder=self.folder))
        service.err.find(lambda line: "failed 10 times in a row (the last end: signal killed SEGV)" in line, "why it waits")
        plc.wait_for(lambda record: record["state"] == 5, "of a service that waits")
        return service

    def test_waits_after_failures_in_a_row_with_the_plc_informed_until_it_is_told_to_try(self):
        plc = self.start(Plc())
        service = self.waiting(plc)
        plc.wait_for(lambda record: record["heartbeat"] >= 10, "with the tenth heartbeat")
        self.assertEqual({(record["health"], record["state"]) for record in plc.writes()}, {(0, 5)})
        self.assertFalse(any("READY" in notice for notice in list(service.notices.queue)))
        service.wait_for_notice(lambda notice: notice.startswith("STATUS=waits"), "with the status")
        service.signal(signal.SIGHUP)
        service.wait_ready()
        plc.wait_for(lambda record: record["state"] == 0, "of a service that starts")
        self.assert_unbroken_heartbeat(plc)
        service.signal(signal.SIGTERM)
        self.assertEqual(service.wait(), 0)
        self.assertFalse((self.folder / "failures").exists(), "an end that was asked for is no failure")

    def test_stops_at_once_while_it_waits_after_failures(self):
        plc = self.start(Plc())
        service = self.waiting(plc)
        service.signal(signal.SIGTERM)
        self.assertEqual(service.wait(), 0, service.err.all)
        self.assert_told_the_end(plc)

    def test_a_start_that_fails_is_counted(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", 0))
            self.lidar_port = taken.getsockname()[1]
            self.write_config(free_port(socket.SOCK_STREAM))
            for failures in ("0\n", "1\n", "2\n"):
                self.assertEqual(self.run_to_end(runtime_folder=self.folder).returncode, 1)
                self.assertEqual((self.folder / "failures").read_text(encoding="ascii"), failures)

    # -- asking for a reload

    def test_whoever_asks_for_a_reload_is_told_what_came_of_it(self):
        plc = self.start(Plc())
        self.write_config(plc.port)
        self.assertEqual(self.run_to_end("--reload", runtime_folder=self.folder).returncode, 1, "nobody is there")
        service = self.start(Service(PROGRAM, self.config, self.folder, runtime_folder=self.folder))
        service.wait_ready()
        good = self.run_to_end("--reload", runtime_folder=self.folder)
        self.assertEqual(good.returncode, 0, good.stderr)
        self.assertIn("new configuration is in force", good.stdout)
        self.write_config(plc.port, "\n[tracking]\nvoxel_sise = 0.5\n")
        bad = self.run_to_end("--reload", runtime_folder=self.folder)
        self.assertEqual(bad.returncode, 1)
        self.assertIn("voxel_sise: unknown key", bad.stderr)
        self.assertIn("the old configuration stays in force", bad.stderr)

    def test_port_in_use_is_one_line_and_exit_1(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", 0))
            self.lidar_port = taken.getsockname()[1]
            self.write_config(free_port(socket.SOCK_STREAM))
            line = self.config.read_text(encoding="utf-8").splitlines().index("[[lidar]]") + 1
            for arguments in ((), ("--stderr",)):
                with self.subTest(arguments):
                    done = self.run_to_end(*arguments)
                    self.assertEqual(done.returncode, 1, done.stderr)
                    self.assertIn(f"{self.config}:{line}: ", done.stderr)
                    self.assertIn(str(self.lidar_port), done.stderr)
                    told = [text for text in done.stderr.splitlines() if "in use" in text]
                    self.assertEqual(len(told), 1, done.stderr)
                    self.assertTrue(arguments or len(done.stderr.splitlines()) == 1, done.stderr)

    def test_errors_of_configuration_and_map_exit_78_with_file_and_line(self):
        self.write_config(502, "\n[tracking]\nvoxel_sise = 0.5\n")
        lines = len(self.config.read_text(encoding="utf-8").splitlines())
        for arguments in ((), ("--check-config",), ("--print-config",)):
            with self.subTest(arguments):
                done = self.run_to_end(*arguments)
                self.assertEqual(done.returncode, 78)
                self.assertIn(f"{self.config}:{lines}: ", done.stderr)
                self.assertIn("voxel_size", done.stderr, "the nearest key is named")
        self.write_config(502)
        self.assertEqual(self.run_to_end("--check-config").returncode, 0)
        (self.folder / "room.pcd").unlink()
        for arguments in ((), ("--check-config",)):
            with self.subTest(arguments):
                done = self.run_to_end(*arguments)
                self.assertEqual(done.returncode, 78)
                self.assertIn("room.pcd", done.stderr)

    def test_a_check_names_the_problems_of_keys_and_of_the_map_together(self):
        self.write_config(502, "\n[tracking]\nvoxel_sise = 0.5\n")
        (self.folder / "room.pcd").unlink()
        done = self.run_to_end("--check-config")
        self.assertEqual(done.returncode, 78)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 2, done.stderr)
        self.assertIn("room.pcd", lines[0])
        self.assertIn("voxel_sise", lines[1])

    def test_a_standard_error_that_nobody_reads_holds_nothing_up(self):
        plc = self.start(Plc())
        self.start(Process([ROOM_LIDAR, self.lidar_port]))
        self.write_config(plc.port)
        service = self.start(Service(PROGRAM, self.config, self.folder, stderr=full_pipe(self)))
        service.wait_ready()
        plc.wait_for(healthy, "with health 1")
        self.write_config(plc.port, "\nnonsense = 1\n")
        for _ in range(20):  # each of them is three lines
            service.signal(signal.SIGHUP)
            plc.wait_for(healthy, "with health 1")
        self.assert_unbroken_heartbeat(plc)
        service.signal(signal.SIGTERM)
        self.assertEqual(service.wait(), 0)
        self.assert_told_the_end(plc)

    def test_a_calibration_file_for_a_model_that_takes_none_exits_78(self):
        self.write_config(502)
        text = self.config.read_text(encoding="utf-8").replace("[[lidar]]\n", '[[lidar]]\ncalibration = "gone.csv"\n')
        self.config.write_text(text, encoding="utf-8")
        done = self.run_to_end("--check-config")
        self.assertEqual(done.returncode, 78)
        line = text.splitlines().index('calibration = "gone.csv"') + 1
        self.assertIn(f"{self.config}:{line}: lidar.calibration: velodyne_vlp16 takes no calibration", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_tells_at_start_and_reload_of_map_points_that_are_no_numbers(self):
        room = self.folder / "room.pcd"
        header, points = room.read_bytes().split(b"DATA binary\n", 1)
        room.unlink()  # the link to what all tests share
        room.write_bytes(header + b"DATA binary\n" + struct.pack("<f", float("nan")) + points[4:])
        self.write_config(free_port(socket.SOCK_STREAM))
        service = self.start(Service(PROGRAM, self.config, self.folder))
        service.wait_ready()

        def told(line):
            return f"{room}: 1 of its {len(points) // 12} points are no numbers" in line

        service.err.find(told, "about the map at the start")
        service.signal(signal.SIGHUP)
        service.err.find(told, "about the map after the reload")

    def test_printed_configuration_reads_back_equal(self):
        self.write_config(502)
        printed = self.run_to_end("--print-config")
        self.assertEqual(printed.returncode, 0, printed.stderr)
        self.config.write_text(printed.stdout, encoding="utf-8")
        self.assertEqual(self.run_to_end("--print-config").stdout, printed.stdout)

    def test_wrong_command_line_exits_2(self):
        done = self.run_to_end("--no-such-option")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--help", done.stderr)
        for option in ("--help", "--version"):
            self.assertEqual(self.run_to_end(option).returncode, 0)

    def assert_told_the_end(self, plc):
        """Waits for it: the PLC's log arrives by a pipe of its own."""
        last = plc.wait_for(lambda record: record["state"] == 7, "of a service that has ended")
        self.assertEqual(last["health"], 0)
        self.assertEqual(plc.writes()[-1], last)

    @staticmethod
    def after_first_health(plc):
        records = plc.writes()
        first = next(i for i, record in enumerate(records) if healthy(record))
        return records[first:]

    def assert_unbroken_heartbeat(self, plc):
        beats = [int(record["heartbeat"]) for record in plc.writes()]
        self.assertEqual(beats, [(beats[0] + i) % 65536 for i in range(len(beats))])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
