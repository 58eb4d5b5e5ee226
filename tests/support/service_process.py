"""Runs the service and its surroundings as processes, for tests: notification socket, PLC, LiDAR.

Nothing here sleeps to let things happen: it waits for a message, a line or a register, for at most a minute.
Every process started here is ended here.
"""
import csv
import os
import pathlib
import queue
import signal
import socket
import subprocess
import threading
import time

PATIENCE_S = 60.0
PLC_SCRIPT = pathlib.Path(__file__).with_name("pymodbus_plc.py")


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Lines:
    """The lines of a stream as they come, read on a thread; `find` waits for one that fulfils a law."""

    def __init__(self, stream):
        self.all = []
        self.queue = queue.Queue()
        self.thread = threading.Thread(target=self.read, args=(stream,), daemon=True)
        self.thread.start()

    def read(self, stream):
        for line in stream:
            self.all.append(line.rstrip("\n"))
            self.queue.put(self.all[-1])
        self.queue.put(None)

    def find(self, law, what):
        deadline = time.monotonic() + PATIENCE_S
        while True:
            try:
                line = self.queue.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                line = None
            if line is None:
                raise AssertionError(f"no line {what}; the last ones:\n" + "\n".join(self.all[-20:]))
            if law(line):
                return line


class Process:
    """A child with its standard input, output and error piped; `stderr`: to this descriptor instead."""

    def __init__(self, command, env=None, stderr=subprocess.PIPE):
        self.child = subprocess.Popen([str(part) for part in command], stdin=subprocess.PIPE, text=True,
                                      stdout=subprocess.PIPE, stderr=stderr, env=env)
        self.out = Lines(self.child.stdout)
        self.err = Lines(self.child.stderr or ())

    def say(self, line):
        self.child.stdin.write(line + "\n")
        self.child.stdin.flush()

    def wait(self):
        code = self.child.wait(PATIENCE_S)
        self.out.thread.join()
        self.err.thread.join()
        return code

    def close(self):
        self.child.stdin.close()
        try:
            self.child.wait(5.0)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()
        for lines, stream in ((self.out, self.child.stdout), (self.err, self.child.stderr)):
            lines.thread.join()
            if stream:
                stream.close()


class Plc(Process):
    """pymodbus_plc.py; its writes as dictionaries of numbers."""

    def __init__(self, *arguments):
        super().__init__(["/usr/bin/python3", PLC_SCRIPT, "--log", "-", *arguments])
        self.port = int(self.out.find(lambda line: line.startswith("port "), "with the PLC's port").split()[1])
        self.header = self.out.find(lambda line: line.startswith("mono_ns,"), "with the log's header").split(",")

    def record(self, line):
        return dict(zip(self.header, (float(value) for value in next(csv.reader([line])))))

    def writes(self):
        return [self.record(line) for line in list(self.out.all) if line[:1].isdigit()]

    def wait_for(self, law, what):
        return self.record(self.out.find(lambda line: line[:1].isdigit() and law(self.record(line)), what))


class Service(Process):
    """hulltrackd with a notification socket of its own; `--stderr` gives its log."""

    def __init__(self, program, config, folder, watchdog_usec=None, stderr=subprocess.PIPE, runtime_folder=None):
        path = str(pathlib.Path(folder) / "notify")
        self.notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.notify.bind(path)
        self.notices = queue.Queue()
        self.notice_thread = threading.Thread(target=self.read_notices, daemon=True)
        self.notice_thread.start()
        env = dict(os.environ, NOTIFY_SOCKET=path)
        env.pop("WATCHDOG_USEC", None)
        if runtime_folder:
            env["RUNTIME_DIRECTORY"] = str(runtime_folder)
        if watchdog_usec:
            env["WATCHDOG_USEC"] = str(watchdog_usec)
        super().__init__([program, "--config", config, "--stderr"], env, stderr)

    def read_notices(self):
        """Reads at once, as a service manager does: a full socket would hold up the service's main thread."""
        while notice := self.notify.recv(4096):
            self.notices.put(notice.decode())

    def wait_for_notice(self, law, what):
        deadline = time.monotonic() + PATIENCE_S
        seen = []
        while not seen or not law(seen[-1]):
            try:
                seen.append(self.notices.get(timeout=max(0.0, deadline - time.monotonic())))
            except queue.Empty:
                raise AssertionError(f"no notice {what} but {seen[-10:]}; log:\n" +
                                     "\n".join(self.err.all)) from None
        return seen[-1]

    def wait_ready(self):
        return self.wait_for_notice(lambda notice: "READY=1" in notice, "READY=1")

    def signal(self, number):
        self.child.send_signal(number)

    def close(self):
        if self.child.poll() is None:
            self.signal(signal.SIGTERM)
        super().close()
        if self.notice_thread.is_alive():
            self.notify.shutdown(socket.SHUT_RDWR)  # ends read_notices
            self.notice_thread.join()
            self.notify.close()
