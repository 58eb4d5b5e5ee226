"""`hulltrack replay` of a LiDAR whose own clock is 10 s off: told as the service tells it, and not used."""
import csv
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

CLOCK_FAULT = 1 << 12
LATE_S = 10


def run(*arguments):
    done = subprocess.run([sys.argv[1], *map(str, arguments)], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stderr


def recorded_later(folder):
    """As if the recorder's clock had been LATE_S ahead of the sensor's: every stamp but the sensor's own."""
    data = bytearray((folder / "lidar.pcap").read_bytes())
    at = 24
    while at < len(data):
        seconds, _, size = struct.unpack_from("<III", data, at)
        struct.pack_into("<I", data, at, seconds + LATE_S)
        at += 16 + size
    (folder / "lidar.pcap").write_bytes(data)
    for name in ("plc.csv", "truth.csv"):
        text = (folder / name).read_text()
        later = re.sub(r"(?m)^\d+(?=,)", lambda t_ns: str(int(t_ns.group()) + LATE_S * 10**9), text)
        (folder / name).write_text(later)


def replay(folder, time_source):
    text = (folder / "hulltrackd.toml").read_text()
    config = folder / f"{time_source}.toml"
    config.write_text(text.replace("[[lidar]]\n", f'[[lidar]]\ntime_source = "{time_source}"\n'))
    summary = run("replay", folder, "--config", config, "--csv", folder / "frames.csv", "--no-timing")
    with open(folder / "frames.csv", newline="") as stream:
        return list(csv.DictReader(stream)), summary


def main():
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "recording"
        run("simulate", "--scenario", "static", "--frames", 12, "--out", folder)
        _, summary = replay(folder, "sensor")
        assert "clock " not in summary, summary

        recorded_later(folder)
        received, _ = replay(folder, "receive")
        frames, summary = replay(folder, "sensor")
        assert re.search(r"^clock +of LiDAR boom not used in 12 frames: 10\.0 s behind", summary, re.M), summary
        assert len(frames) == 12
        for frame, reference in zip(frames, received):
            assert int(frame.pop("faults")) == int(reference.pop("faults")) | CLOCK_FAULT
            assert frame == reference, "the time of reception is used, and the pose is as good as ever"


if __name__ == "__main__":
    main()
