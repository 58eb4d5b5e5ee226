"""The live service gives the poses of `hulltrack replay`: the same recording through registers and files.

A recording of the simulator is sent over loopback in real time: its datagrams by udp_replay, its joints by a
PLC that is not libmodbus, to hulltrackd as a process. Several --lidar are on one boom, each with a port of its
own. The poses in the registers must equal those of `hulltrack replay`, frame by frame. Timing is reported, not judged: frames whose packets this machine sent
late have other joints than the recording, so they are left out, and a machine too busy to send enough of
them in time skips the test (77).
"""
import argparse
import csv
import pathlib
import re
import socket
import signal
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "support"))
from merged_recording import FIRST_PORT, merge  # noqa: E402
from service_process import PATIENCE_S, Plc, Process, Service, free_port  # noqa: E402

FRAME_NS = 100_000_000
LATE_NS = 5_000_000  # a frame with a packet sent later than this is not compared
ENOUGH_FRAMES = 20
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
# Stamps of polls and packets on a loopback interface are good to a fraction of a millisecond, in which the
# joints move the LiDAR by a fraction of a millimetre: that is the median. Now and then such a difference
# decides whether the registration takes one more step, and a last step may be as long as its epsilons
# (1 mm and 0.1 deg, felt at some metres from the middle of the scan).
MEDIAN_M, MEDIAN_DEG = 0.002, 0.01
LIMIT_M, LIMIT_DEG = 0.010, 0.1


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hulltrack", required=True)
    parser.add_argument("--hulltrackd", required=True)
    parser.add_argument("--udp-replay", required=True)
    parser.add_argument("--lidar", nargs="+", default=["velodyne_vlp16"], help="one or more models")
    parser.add_argument("--frames", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def simulate(args, folder):
    """The recording of all LiDARs."""
    recordings = []
    for i, model in enumerate(args.lidar):
        recordings.append(folder / f"recording{i}")
        subprocess.run([args.hulltrack, "simulate", "--scenario", "berth", "--frames", str(args.frames), "--seed",
                        str(args.seed), "--lidar", model, "--out", recordings[-1]], check=True, capture_output=True)
    if len(recordings) == 1:
        return recordings[0]
    merge(recordings, folder / "merged")
    return folder / "merged"


def replayed_poses(hulltrack, recording):
    table = recording / "replay.csv"
    subprocess.run([hulltrack, "replay", recording, "--config", recording / "hulltrackd.toml", "--csv", table],
                   check=True, capture_output=True)
    with open(table, newline="", encoding="ascii") as file:
        return {int(row["frame"]): row for row in csv.DictReader(file)}


def live_config(recording, plc_port, lidar_ports):
    text = (recording / "hulltrackd.toml").read_text(encoding="utf-8")
    text = re.sub(r"port = 1502", f"port = {plc_port}", text)
    for i, port in enumerate(lidar_ports):
        text = re.sub(rf"port = {FIRST_PORT + i}\n", f'port = {port}\nbind = "127.0.0.1"\n', text)
    path = recording / "live.toml"
    path.write_text(text, encoding="utf-8")
    return path


def run_live(args, recording):
    """The PLC's log of writes and the sender's log of (capture_ns, sent_ns)."""
    lidar_ports = [free_port(socket.SOCK_DGRAM) for _ in args.lidar]
    sent_log = recording / "sent.csv"
    sender = Process([args.udp_replay, recording / "lidar.pcap", sent_log,
                      *(f"{FIRST_PORT + i}:{port}" for i, port in enumerate(lidar_ports))])
    first_ns = int(sender.out.find(lambda line: line.startswith("first "), "with the first stamp").split()[1])
    plc = Plc("--joints-csv", recording / "plc.csv", "--epoch-ns", str(first_ns), "--cycle-ms", "0")
    service = Service(args.hulltrackd, live_config(recording, plc.port, lidar_ports), recording)
    try:
        service.wait_ready()
        start_ns = time.monotonic_ns() + 500_000_000
        plc.say(f"start {start_ns}")
        sender.say(f"start {start_ns}")
        sender.child.wait(PATIENCE_S + args.frames * FRAME_NS * 1e-9)
        service.signal(signal.SIGTERM)
        assert service.wait() == 0, service.err.all
        writes = plc.writes()
        log = service.err.all
    finally:
        for process in (service, sender, plc):
            process.close()
    sent = [tuple(map(int, line.split(","))) for line in sent_log.read_text(encoding="ascii").splitlines()]
    return writes, sent, log


def frames_of(sent):
    """Per frame number: the worst lateness of its packets, and when the packet that completed it left."""
    first_capture, first_sent = sent[0]
    late, completed = {}, {}
    for capture, left in sent:
        number = (capture - first_capture) // FRAME_NS
        late[number] = max(late.get(number, 0), (left - first_sent) - (capture - first_capture))
        if number > 0:
            completed.setdefault(number - 1, left)
    return late, completed


def in_time(late, number):
    """Whether a frame and its neighbours were sent in time: registration begins where the frame before ended."""
    return max(late.get(number + step, 0) for step in (-1, 0, 1)) <= LATE_NS


def compare(writes, replayed, late):
    """Differences (m, deg) of the frames published with health 1 that were sent in time."""
    metres, degrees = [], []
    published = {int(write["frame"]): write for write in writes if write["health"] == 1}
    for number, write in published.items():
        row = replayed.get(number)
        if row is None or not row["x"] or not in_time(late, number):
            continue
        differences = [abs(write[key] - float(row[key])) for key in POSE]
        metres.append(max(differences[:3]))
        degrees.append(max(differences[3:]))
    return published, metres, degrees


def report_timing(writes, completed, replayed):
    first_write = {}
    for write in writes:
        if write["health"] == 1:
            first_write.setdefault(int(write["frame"]), write)
    latencies = [(write["mono_ns"] - completed[number]) * 1e-6
                 for number, write in first_write.items() if number in completed]
    gaps = [(b["mono_ns"] - a["mono_ns"]) * 1e-6 for a, b in zip(writes, writes[1:])]
    processing = [write["processing_ms"] for write in first_write.values()]
    alone = [float(row["ms"]) for row in replayed.values() if row["ms"]]
    print(f"last packet received to registers ready: median {statistics.median(processing):.1f} ms, of which the "
          f"wait for the joints and the tracking; the tracking takes {statistics.median(alone):.1f} ms in replay")
    print(f"last packet sent to registers written: median {statistics.median(latencies):.1f} ms, "
          f"worst {max(latencies):.1f} ms over {len(latencies)} frames")
    print(f"gap between writes: median {statistics.median(gaps):.1f} ms, worst {max(gaps):.1f} ms")


def main():
    args = arguments()
    with tempfile.TemporaryDirectory() as folder:
        recording = simulate(args, pathlib.Path(folder))
        replayed = replayed_poses(args.hulltrack, recording)
        writes, sent, log = run_live(args, recording)
    late, completed = frames_of(sent)
    published, metres, degrees = compare(writes, replayed, late)
    healthy = [number for number, row in replayed.items() if row["health"] == "1"]
    print(f"{len(replayed)} frames; health 1 in {len(healthy)} of replay and {len(published)} of live; "
          f"{len(metres)} sent in time and compared")
    last = writes[-1]
    assert (last["health"], last["state"]) == (0, 7), last
    if len(metres) < ENOUGH_FRAMES:
        print("\n".join(log))
        if any("faster than they can be processed" in line for line in log):
            print("the service cannot keep up with the scans on this machine: skipped")
            return 77
        to_compare = sum(1 for number in healthy if in_time(late, number))
        assert to_compare < 3 * ENOUGH_FRAMES, "the live service was seldom healthy"
        print(f"too few frames were sent in time to compare (lateness {statistics.median(late.values()) * 1e-6:.1f} ms "
              "in the median): skipped")
        return 77
    report_timing(writes, completed, replayed)
    print(f"live against replay: {1e3 * statistics.median(metres):.2f} mm in the median, {1e3 * max(metres):.2f} mm "
          f"at most; {max(degrees):.4f} deg at most")
    assert max(metres) <= LIMIT_M and max(degrees) <= LIMIT_DEG, "live and replay differ"
    assert statistics.median(metres) <= MEDIAN_M and statistics.median(degrees) <= MEDIAN_DEG, "they differ at large"
    return 0


if __name__ == "__main__":
    sys.exit(main())
