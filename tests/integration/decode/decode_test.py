"""`hulltrack decode` row by row against a plain decoder of the VLP-16's packet, and its answers to bad input.

The packets are the real capture where it is at hand, and always ones made here."""
import csv
import math
import pathlib
import struct
import sys
import tempfile

from decode_tool import datagrams, decode

ELEVATION = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]
FIRING_NS, SEQUENCE_NS, BLOCK_NS = 2304, 55296, 110592


def expected_rows(capture, firing_correction=True):
    for index, (stamp, payload) in enumerate(datagrams(capture)):
        pair = 2 if payload[1204] == 0x39 else 1
        azimuth = [struct.unpack_from("<H", payload, 100 * b + 2)[0] for b in range(12)]
        steps = [(azimuth[b + pair] - azimuth[b]) % 36000 for b in range(12 - pair)]
        steps += steps[-pair:]
        last_ns = (12 // pair - 1) * BLOCK_NS + SEQUENCE_NS + 15 * FIRING_NS
        for block in range(12):
            for slot in range(32):
                distance, intensity = struct.unpack_from("<HB", payload, 100 * block + 4 + 3 * slot)
                if distance == 0:
                    continue
                laser = slot % 16
                in_block = slot // 16 * SEQUENCE_NS + laser * FIRING_NS
                turn = azimuth[block] + (steps[block] * in_block / BLOCK_NS if firing_correction else 0)
                a, e, d = math.radians(turn / 100), math.radians(ELEVATION[laser]), distance * 0.002
                yield (index, laser, stamp - last_ns + block // pair * BLOCK_NS + in_block,
                       d * math.cos(e) * math.cos(a), -d * math.cos(e) * math.sin(a), d * math.sin(e), intensity)


def compare(rows, expected):
    count, worst = 0, 0.0
    for row, want in zip(rows, expected, strict=True):
        assert [int(row[i]) for i in (0, 1, 2, 6)] == [want[i] for i in (0, 1, 2, 6)], (row, want)
        worst = max(worst, math.dist([float(v) for v in row[3:6]], want[3:6]))
        count += 1
    assert worst < 2e-5, worst  # float against double at 100 m
    return count, worst


def check_capture(tool, capture, folder):
    out = folder / "points.csv"
    for flags, correction in (([], True), (["--no-firing-correction"], False)):
        run = decode(tool, capture, "--model", "velodyne_vlp16", "--no-vertical-offset", *flags, "--out", out)
        assert run.returncode == 0, run.stderr
        with out.open(newline="") as file:
            rows = csv.reader(file)
            assert next(rows) == "packet,channel,t_ns,x,y,z,intensity".split(",")
            count, worst = compare(rows, expected_rows(capture, correction))
        print(f"{capture.name}: {count} points, worst {worst * 1e3:.4f} mm")

    pcd = folder / "points.pcd"
    assert decode(tool, capture, "--model", "velodyne_vlp16", "--out", pcd).returncode == 0
    header = pcd.read_bytes()[:400].decode("latin-1").split("\n")
    assert "FIELDS x y z intensity" in header and f"POINTS {count}" in header, header


def made_capture(path, packets=80):
    """Single return, 600 rpm, through azimuth zero, every third slot without a return."""
    records = [struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 1)]
    turn = 35000.0
    for n in range(packets):
        payload = b""
        for _ in range(12):
            payload += struct.pack("<HH", 0xEEFF, round(turn) % 36000)
            payload += b"".join(struct.pack("<HB", 0 if k % 3 == 0 else 1000 + 700 * k + n, k) for k in range(32))
            turn += 39.8
        payload += struct.pack("<IBB", n * 1327, 0x37, 0x22)
        udp = struct.pack(">HHHH", 2368, 2368, 8 + len(payload), 0) + payload
        ip = struct.pack(">BBHHHBBHII", 0x45, 0, 20 + len(udp), n, 0, 64, 17, 0, 0xC0A801C9, 0xC0A80164) + udp
        frame = bytes(12) + b"\x08\x00" + ip
        records.append(struct.pack("<IIII", 1700000000, n * 1327, len(frame), len(frame)) + frame)
    path.write_bytes(b"".join(records))
    return path


def check_refusals(tool, capture, folder):
    out = folder / "x.csv"
    cut = folder / "cut.pcap"
    cut.write_bytes(capture.read_bytes()[:-100])
    cases = [
        ((capture, "--model", "velodyne_vlp61", "--out", out), 2, "did you mean velodyne_vlp16?"),
        ((capture, "--model", "velodyne_vlp32c", "--out", out), 1, "saw VLP-16 (product code 0x22)"),
        ((capture, "--model", "velodyne_vlp16", "--port", 99, "--out", out), 1, "UDP ports seen: 2368 (80)"),
        ((folder / "none.pcap", "--model", "velodyne_vlp16", "--out", out), 1, "none.pcap: cannot be opened"),
        ((pathlib.Path(__file__), "--model", "velodyne_vlp16", "--out", out), 1, "not a capture"),
        ((capture, "--model", "velodyne_vlp16", "--out", folder / "x.txt"), 2, ".csv or .pcd"),
        ((capture, "--model", "velodyne_vlp16", "--source", "here", "--out", out), 2, "no IPv4 address"),
        ((capture, "--out", out), 2, "--model is required"),
        ((capture, "--model", "velodyne_vlp16", "--calibration", capture, "--out", out), 1,
         "velodyne_vlp16 takes no calibration file"),
    ]
    for arguments, code, words in cases:
        run = decode(tool, *arguments)
        assert run.returncode == code and words in run.stderr, (arguments, run.returncode, run.stderr)
        assert not out.exists(), arguments
    run = decode(tool, cut, "--model", "velodyne_vlp16", "--out", out)
    assert run.returncode == 1 and "broken after record 79" in run.stderr, run.stderr
    assert out.read_text().splitlines()[-1].startswith("78,"), "what came before the cut is kept"


def check_what_was_there_before(tool, capture, folder):
    """Only points replace an old file, and the capture is never written over."""
    link, old = folder / "capture.csv", folder / "old.csv"
    link.symlink_to(capture)
    before = capture.read_bytes()
    old.write_text("yesterday's points")
    for arguments, words in (((capture, "--out", link), "is what it reads from"),
                             ((capture, "--port", 99, "--out", old), "UDP ports seen"),
                             ((pathlib.Path(__file__), "--out", old), "not a capture")):
        run = decode(tool, *arguments, "--model", "velodyne_vlp16")
        assert run.returncode != 0 and words in run.stderr, (arguments, run.returncode, run.stderr)
        assert run.stderr.count("\n") == 1, run.stderr
    assert capture.read_bytes() == before and old.read_text() == "yesterday's points"
    assert decode(tool, capture, "--model", "velodyne_vlp16", "--out", old).returncode == 0
    assert old.read_text().startswith("packet,channel,")
    assert not list(folder.glob("*.part"))


def main():
    tool, shared = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = made_capture(folder / "made.pcap")
        check_capture(tool, made, folder)
        check_refusals(tool, made, folder)
        check_what_was_there_before(tool, made, folder)
        real = shared / "lidar" / "velodyne_vlp16" / "packets.pcap"
        if real.exists():
            check_capture(tool, real, folder)
        else:
            print(f"{real} is absent: only packets made here were checked")


main()
