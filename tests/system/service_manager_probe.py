"""Runs inside the container of service_manager_test.py, beside a real systemd: what it and the PLC see of
hulltrackd.service. Nothing here sleeps to let things happen or judges how long they took: it waits for a
property, a register or a line of the journal. The PLC's log is the clock: writes go on all the time.

A watchdog needs a machine that keeps up. Where frames take too long for it (an instrumented binary, say) nothing
is tested; a test that fails while machine or frames were slow is skipped and ends the run. Both exit with 77.
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
from contextlib import closing

sys.path.insert(0, "/opt")
from service_process import Plc, Process, Service  # noqa: E402

UNIT = "hulltrackd.service"
CONFIG = pathlib.Path("/etc/hulltrackd/hulltrackd.toml")
GOOD = CONFIG.read_text(encoding="utf-8")
PATIENCE_S = 60.0
TURN_LIMIT_S = 0.5  # a turn of a thread that takes longer is a hang to the service
SLOW_S = TURN_LIMIT_S / 2.0  # a turn is more than the frame in it
FRAMES_TO_JUDGE = 20


def systemctl(*arguments):
    return subprocess.run(["systemctl", *arguments], capture_output=True, text=True, check=False)


def property_of(name, unit=UNIT):
    return systemctl("show", unit, "--property", name, "--value").stdout.strip()


def journal():
    return subprocess.run(["journalctl", "--unit", UNIT, "--output", "cat", "--no-pager"], capture_output=True,
                          text=True, check=False).stdout


def until(law, what):
    deadline = time.monotonic() + PATIENCE_S
    while not law():
        assert time.monotonic() < deadline, f"never: {what}; the journal ends with\n{journal()[-2000:]}"
        time.sleep(0.02)


def fill(path):
    """Until not even the first datagram of a new socket fits."""
    sockets = []
    sent = True
    while sent:
        sockets.append(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK))
        sockets[-1].connect(path)
        sent = False
        try:
            while True:
                sockets[-1].send(b"<15>fill")
                sent = True
        except BlockingIOError:
            pass
    return sockets


def main_pid():
    return int(property_of("MainPID"))


class Stalls(threading.Thread):
    """How late this process is woken at worst: what holds it up holds the service up as well."""

    def __init__(self):
        super().__init__(daemon=True)
        self.longest_s = 0.0

    def run(self):
        while True:
            asleep = time.monotonic()
            time.sleep(0.02)
            self.longest_s = max(self.longest_s, time.monotonic() - asleep - 0.02)


STALLS = Stalls()


def sanitizer_spoke():
    return any(word in journal() for word in ("Sanitizer", "runtime error:"))


def too_slow(test):
    """Why a failure of `test` says nothing of the unit, or None. What a sanitizer found is always a failure."""
    if sanitizer_spoke():
        return None
    writes = test.plc.writes() if hasattr(test, "plc") else []
    frame_s = max((write["processing_ms"] for write in writes), default=0.0) / 1000.0
    if max(frame_s, STALLS.longest_s) < SLOW_S:
        return None
    return (f"failed on a machine too slow for a watchdog: a frame took up to {frame_s:.2f} s, this process was "
            f"held up for {STALLS.longest_s:.2f} s")


class Result(unittest.TextTestResult):
    def failed(self, test, error, add):
        reason = too_slow(test)
        if reason is None:
            add(test, error)
        else:
            self.addSkip(test, f"{reason}; {error[1]}")
            self.stop()

    def addFailure(self, test, error):
        self.failed(test, error, super().addFailure)

    def addError(self, test, error):
        self.failed(test, error, super().addError)


def setUpModule():
    """Without the unit and its watchdog: how long do frames take here?"""
    STALLS.start()
    frames_ms = set()
    with closing(Plc("--port", "1502")) as plc, closing(Process(["/opt/room_lidar", "2368"])), \
            closing(Service("/opt/hulltrackd", CONFIG, "/root")):
        while len(frames_ms) < FRAMES_TO_JUDGE:
            write = plc.wait_for(lambda write: write["processing_ms"] not in {0.0, *frames_ms}, "of another frame")
            frames_ms.add(write["processing_ms"])
    slowest_s = max(frames_ms) / 1000.0
    if slowest_s > TURN_LIMIT_S:
        raise unittest.SkipTest(f"the watchdog cannot be kept here: a frame took {slowest_s:.2f} s, and a turn of more "
                                f"than {TURN_LIMIT_S} s is a hang")


class UnitTest(unittest.TestCase):
    def setUp(self):
        STALLS.longest_s = 0.0
        CONFIG.write_text(GOOD, encoding="utf-8")
        self.plc = self.start(Plc("--port", "1502"))
        self.start(Process(["/opt/room_lidar", "2368"]))
        self.addCleanup(systemctl, "stop", UNIT)
        started = systemctl("start", UNIT)  # returns when READY=1 has come
        self.assertEqual(started.returncode, 0, started.stderr + journal())
        self.wait_healthy()

    def tearDown(self):
        self.assertFalse(sanitizer_spoke(), journal())

    def start(self, process):
        self.addCleanup(process.close)
        return process

    def wait_healthy(self):
        """Health 1 in a block that is written from now on."""
        begin = time.monotonic_ns()
        return self.plc.wait_for(lambda write: write["health"] == 1 and write["mono_ns"] > begin, "with health 1")

    def wait_writes(self, count):
        begin = len(self.plc.writes())
        until(lambda: len(self.plc.writes()) >= begin + count, f"{count} writes")

    def wait_restarted(self, old, restarts):
        until(lambda: int(property_of("NRestarts")) == restarts and property_of("ActiveState") == "active",
              f"restart {restarts}")
        self.assertNotIn(main_pid(), (0, old))
        self.wait_healthy()

    def test_is_ready_says_how_it_is_and_feeds_the_watchdog(self):
        self.assertEqual(property_of("ActiveState"), "active")
        until(lambda: "tracking" in property_of("StatusText"), "the status text")
        fed = property_of("WatchdogTimestampMonotonic")
        until(lambda: property_of("WatchdogTimestampMonotonic") not in (fed, "0"), "the watchdog is fed")
        self.assertEqual(property_of("NRestarts"), "0")

    def test_a_reload_keeps_the_process(self):
        pid = main_pid()
        reload = systemctl("reload", UNIT)
        self.assertEqual(reload.returncode, 0, reload)
        until(lambda: "the new configuration is in force" in journal(), "the reload")
        self.wait_healthy()
        CONFIG.write_text(GOOD + "nonsense = 1\n", encoding="utf-8")
        self.assertNotEqual(systemctl("reload", UNIT).returncode, 0)
        until(lambda: "reload refused" in journal(), "the refusal")
        self.wait_healthy()
        self.assertEqual((main_pid(), property_of("ActiveState")), (pid, "active"))
        asked = subprocess.run(["/opt/hulltrackd", "--reload"], capture_output=True, text=True, check=False)
        self.assertEqual(asked.returncode, 1)
        self.assertIn("nonsense: unknown key", asked.stderr)

    def test_is_restarted_after_it_was_killed_as_by_the_kernel_out_of_memory(self):
        pid = main_pid()
        os.kill(pid, signal.SIGKILL)
        self.wait_restarted(pid, 1)

    def test_waits_after_failures_in_a_row_and_the_plc_sees_a_fault_meanwhile(self):
        for restarts in (1, 2, 3):
            pid = main_pid()
            os.kill(pid, signal.SIGKILL)
            self.wait_restarted(pid, restarts)
        begin = time.monotonic_ns()
        os.kill(main_pid(), signal.SIGKILL)
        self.plc.wait_for(lambda write: write["mono_ns"] > begin and write["state"] == 5, "of a service that waits")
        until(lambda: "failed 4 times in a row (the last end: signal killed KILL)" in journal(), "why it waits")
        self.wait_healthy()
        # From the moment of its end on: the old service's last, then nothing but health 0 until a session runs.
        states = [write["state"] for write in self.plc.writes() if write["mono_ns"] > begin]
        self.assertEqual(set(states[states.index(5):states.index(0)]), {5})
        self.assertEqual(property_of("NRestarts"), "4")

    def test_is_restarted_by_the_watchdog_after_a_hang(self):
        pid = main_pid()
        os.kill(pid, signal.SIGSTOP)
        self.wait_restarted(pid, 1)
        self.assertIn("Watchdog timeout", journal())

    def test_an_error_in_the_configuration_is_not_tried_again(self):
        CONFIG.write_text(GOOD + "nonsense = 1\n", encoding="utf-8")
        self.assertNotEqual(systemctl("restart", UNIT).returncode, 0)
        until(lambda: property_of("ActiveState") == "failed", "failed")
        self.assertEqual((property_of("ExecMainStatus"), property_of("NRestarts")), ("78", "0"))
        systemctl("reset-failed", UNIT)

    def test_a_restart_into_an_error_leaves_no_health_behind(self):
        CONFIG.write_text(GOOD + "nonsense = 1\n", encoding="utf-8")
        self.wait_healthy()
        os.kill(main_pid(), signal.SIGKILL)
        until(lambda: property_of("ActiveState") == "failed", "failed")
        self.assertEqual(property_of("ExecMainStatus"), "78")
        until(lambda: self.plc.writes()[-1]["state"] == 7, "the last word of a service that gives up")
        self.assertEqual(self.plc.writes()[-1]["health"], 0)
        systemctl("reset-failed", UNIT)

    def test_what_reads_the_files_comes_last_for_the_processor_and_first_for_the_kernel(self):
        pid, pipe = main_pid(), CONFIG.with_name("pipe")
        os.mkfifo(pipe, 0o644)
        self.addCleanup(pipe.unlink)
        pipe.chmod(0o644)
        CONFIG.write_text(GOOD.replace('"velodyne_vlp16"', '"hesai_xt32"\ncalibration = "pipe"'), encoding="utf-8")
        reload = subprocess.Popen(["systemctl", "reload", UNIT], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open(pipe, "wb"):  # returns when it is there
            reader = next(int(child) for child in
                          pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split())
            self.assertEqual(pathlib.Path(f"/proc/{reader}/oom_score_adj").read_text(encoding="ascii"), "1000\n")
            self.assertEqual(os.getpriority(os.PRIO_PROCESS, reader), 10)
            os.kill(reader, signal.SIGKILL)  # as the kernel does
        self.assertNotEqual(reload.wait(PATIENCE_S), 0)
        until(lambda: "reload refused" in journal(), "the refusal")
        self.wait_healthy()
        self.assertEqual((main_pid(), property_of("ActiveState")), (pid, "active"))

    def test_a_stuck_journal_holds_nothing_up(self):
        pid, journald = main_pid(), int(property_of("MainPID", "systemd-journald.service"))
        CONFIG.write_text(GOOD + "nonsense = 1\n", encoding="utf-8")
        os.kill(journald, signal.SIGSTOP)
        self.addCleanup(os.kill, journald, signal.SIGCONT)
        fillers = fill("/dev/log")
        self.addCleanup(lambda: [filler.close() for filler in fillers])
        first = len(self.plc.writes())
        for _ in range(20):  # each of them is three lines
            os.kill(pid, signal.SIGHUP)
            self.wait_writes(2)
        self.wait_healthy()
        beats = [int(write["heartbeat"]) for write in self.plc.writes()[first:]]
        self.assertEqual(beats, [(beats[0] + i) % 65536 for i in range(len(beats))], "one process wrote them all")
        self.assertEqual(pathlib.Path(f"/proc/{pid}/comm").read_text(encoding="ascii"), "hulltrackd\n")

    def test_runs_locked_down_on_file_systems_that_cannot_be_written(self):
        pid = main_pid()
        status = dict(line.split(":\t", 1) for line in
                      pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines())
        self.assertEqual((status["NoNewPrivs"], status["Seccomp"], int(status["CapEff"], 16)), ("1", "2", 0))
        self.assertNotIn("0", status["Uid"].split())
        for folder in ("/", "/var", "/etc", "/usr"):
            flags = os.statvfs(f"/proc/{pid}/root{folder}").f_flag
            self.assertTrue(flags & os.ST_RDONLY, f"{folder} can be written")

    def test_datagrams_of_addresses_that_the_unit_does_not_allow_never_arrive(self):
        subprocess.run(["ip", "address", "replace", "10.9.9.9/32", "dev", "lo"], check=True)
        senders = {}
        for address in ("10.9.9.9", "127.0.0.9"):
            senders[address] = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.addCleanup(senders[address].close)
            senders[address].bind((address, 0))

        def send():  # the one that must not arrive first
            for sender in senders.values():
                sender.sendto(b"no packet of a LiDAR", ("127.0.0.1", 2368))
            return "127.0.0.9" in journal()

        until(send, "a line about the sender that is allowed")
        self.assertNotIn("10.9.9.9", journal())

    def test_stops_with_health_0_and_state_7(self):
        self.assertEqual(systemctl("stop", UNIT).returncode, 0)
        self.assertEqual((property_of("ActiveState"), property_of("Result")), ("inactive", "success"))
        until(lambda: self.plc.writes()[-1]["state"] == 7, "the last word")
        self.assertEqual(self.plc.writes()[-1]["health"], 0)


if __name__ == "__main__":
    result = unittest.main(testRunner=unittest.TextTestRunner(verbosity=2, resultclass=Result), exit=False).result
    sys.exit((77 if result.skipped else 0) if result.wasSuccessful() else 1)
