"""`hulltrack replay` of recordings with one thing wrong: exit 1 and one line that names the file and the remedy.

A short simulated recording is spoilt in one way at a time. Every line must name the file (and the line in it)
and say what to do; what comes before a cut is replayed. A map that is none is an error of the configuration
for the service: exit 78."""
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile


def pcap_records(data):
    """(header, frame) of each record of a little-endian pcap."""
    at = 24
    while at < len(data):
        size = struct.unpack_from("<I", data, at + 8)[0]
        yield data[at:at + 16], data[at + 16:at + 16 + size]
        at += 16 + size


def edit(name, change):
    """Spoils the bytes of one file of a recording."""
    def spoil(folder):
        file = folder / name
        file.write_bytes(change(file.read_bytes()))
    return spoil


def remove(name):
    return lambda folder: (folder / name).unlink()


def lines(change):
    """A change of the list of lines, counted from 0."""
    return lambda data: b"\n".join(change(data.split(b"\n")))


def swap(rows):
    rows[5], rows[6] = rows[6], rows[5]
    return rows


def put(index, text):
    def change(rows):
        rows[index] = text
        return rows
    return lines(change)


def an_hour_earlier(data):
    """A recorder's clock in another time zone than the capture's."""
    header, *rows = data.rstrip(b"\n").split(b"\n")
    earlier = (b",".join([str(int(t_ns) - 3600 * 10**9).encode(), rest])
             for t_ns, rest in (row.split(b",", 1) for row in rows))
    return b"\n".join([header, *earlier]) + b"\n"


def without_udp(data):
    """Every frame becomes ARP."""
    return data[:24] + b"".join(head + frame[:12] + b"\x08\x06" + frame[14:] for head, frame in pcap_records(data))


def noise_payload(data):
    """The same datagrams to the same port, of zeros."""
    return data[:24] + b"".join(head + frame[:42] + bytes(len(frame) - 42) for head, frame in pcap_records(data))


# what is wrong, how it is done, the file that the line begins with, words of problem and remedy
REFUSALS = [
    ("no pcap", remove("lidar.pcap"), "lidar.pcap: ", ["is missing", "holds lidar.pcap and plc.csv"]),
    ("no plc.csv", remove("plc.csv"), "plc.csv: ", ["is missing", "holds lidar.pcap and plc.csv"]),
    ("no configuration", remove("hulltrackd.toml"), "hulltrackd.toml: ", ["is missing", "--config"]),
    ("empty pcap", edit("lidar.pcap", lambda data: b""), "lidar.pcap: ", ["not a capture", "expected a pcap"]),
    ("text for a pcap", edit("lidar.pcap", lambda data: b"hello, world\n" * 9), "lidar.pcap: ", ["not a capture"]),
    ("no UDP", edit("lidar.pcap", without_udp), "lidar.pcap: ", ["no UDP was seen at all", "network interface"]),
    ("another port", edit("hulltrackd.toml", lambda data: data.replace(b"port = 2368", b"port = 2369")),
     "lidar.pcap: ", ["UDP ports seen: 2368 (", "no datagrams for any [[lidar]] (UDP port 2369)", "correct its port"]),
    ("another source", edit("hulltrackd.toml", lambda data: data.replace(
        b"port = 2368", b"port = 2368\nsource = \"10.9.8.7\"")), "lidar.pcap: ", ["(UDP port 2368 from 10.9.8.7)", "or source"]),
    ("noise on the port", edit("lidar.pcap", noise_payload), "lidar.pcap: ",
     ["none of ", "is of lidar \"boom\", a velodyne_vlp16", "expected block flag", "correct its model or port"]),
    ("another model", edit("hulltrackd.toml", lambda data: data.replace(b"velodyne_vlp16\"", b"velodyne_vlp32c\"")),
     "lidar.pcap: ", ["none of ", "saw VLP-16", "correct its model"]),
    ("a value that is none", edit("plc.csv", put(4, b"1767251399559603065,0.1,here,0.2,3,0")), "plc.csv:5: ",
     ["theta_r is `here`", "must be a finite number"]),
    ("NaN", edit("plc.csv", put(4, b"1767251399559603065,nan,0.1,0.2,3,0")), "plc.csv:5: ", ["d_x is `nan`"]),
    ("a field too few", edit("plc.csv", put(3, b"1767251399559603065,0.1,0.1")), "plc.csv:4: ",
     ["has 3 fields, must have 6"]),
    ("a line cut short", edit("plc.csv", lambda data: data.rstrip(b"\n").rsplit(b",", 3)[0]), "plc.csv:",
     ["has 3 fields, must have 6", "cut short"]),
    ("another header", edit("plc.csv", put(0, b"time,x,y,z")), "plc.csv:1: ", ["the first line must be `t_ns,d_x,"]),
    ("no rows", edit("plc.csv", lines(lambda rows: rows[:1])), "plc.csv: ", ["has a header but no rows", "record it again"]),
    ("time backwards", edit("plc.csv", lines(swap)), "plc.csv:7: ",
     ["time runs backwards", "in line 6", "must be in order of time"]),
    ("joints of another hour", edit("plc.csv", an_hour_earlier), "plc.csv: ",
     ["its rows lie 3599.2 s before the datagrams of ", "lidar.pcap", "stamped by one clock"]),
    ("truth of another format", edit("truth.csv", put(0, b"truth")), "truth.csv:1: ", ["the first line must be"]),
    ("text for a map", edit("hull.pcd", lambda data: b"solid hull\n"), "hull.pcd: ",
     ["neither a PCD nor a PLY file", "convert"]),
    ("no map", remove("hull.pcd"), "hull.pcd: ", ["cannot be opened", "name an existing PCD or PLY"]),
    ("a map cut short", edit("hull.pcd", lambda data: data[:len(data) // 2]), "hull.pcd: ", []),
]


def replay(tool, folder, *flags):
    return subprocess.run([tool, "replay", str(folder), *flags], capture_output=True, text=True, timeout=120)


def check_refusal(tool, folder, name, begins, words):
    run = replay(tool, folder)
    context = f"{name}: exit {run.returncode}, {run.stderr!r}"
    assert run.returncode == 1, context
    assert run.stderr.count("\n") == 1 and run.stderr.endswith("\n"), context
    assert run.stderr.startswith(f"hulltrack replay: {folder / begins}"), context
    for word in words:
        assert word in run.stderr, context
    print(run.stderr, end="")


def check_missing_folder(tool, good, parent):
    for flags in ([], ["--config", str(good / "hulltrackd.toml")]):
        run = replay(tool, parent / "nowhere", *flags)
        assert run.returncode == 1 and run.stderr.count("\n") == 1, run.stderr
        assert f"{parent / 'nowhere'}: is no folder; name the folder that holds lidar.pcap" in run.stderr, run.stderr
    run = subprocess.run([tool, "replay"], capture_output=True, text=True, timeout=120)
    assert run.returncode == 2 and "REC is required" in run.stderr, run.stderr


def check_cut(tool, folder):
    """Everything before the cut is replayed, then the cut is told."""
    capture = folder / "lidar.pcap"
    whole = folder / "whole.csv"
    cut = folder / "cut.csv"
    assert replay(tool, folder, "--no-timing", "--quiet", "--csv", str(whole)).returncode == 0
    capture.write_bytes(capture.read_bytes()[:-100])
    run = replay(tool, folder, "--no-timing", "--quiet", "--csv", str(cut))
    assert run.returncode == 1 and run.stderr.count("\n") == 1, run.stderr
    assert run.stderr.startswith(f"hulltrack replay: {capture}: broken after record "), run.stderr
    assert "what comes before it can be used" in run.stderr, run.stderr
    before = cut.read_text().splitlines()
    assert len(before) >= 2 and before == whole.read_text().splitlines()[:len(before)], before


def check_unfinished_turn(tool, folder):
    """With revolution framing the last row is a whole turn, not what the capture holds of the next."""
    config = folder / "hulltrackd.toml"
    config.write_text(config.read_text() + "\n[tracking]\nframing = \"revolution\"\n")
    capture = folder / "lidar.pcap"
    data = capture.read_bytes()
    records = [head + frame for head, frame in pcap_records(data)]
    table = folder / "turns.csv"
    capture.write_bytes(data[:24] + b"".join(records[:190]))  # 75 to 76 datagrams a turn
    assert replay(tool, folder, "--no-timing", "--quiet", "--csv", str(table)).returncode == 0
    assert len(table.read_text().splitlines()) == 1 + 2, table.read_text()
    capture.write_bytes(data[:24] + b"".join(records[:40]))
    run = replay(tool, folder, "--no-timing", "--quiet")
    assert run.returncode == 1 and "less than one turn" in run.stderr, run.stderr


def check_command_lines(tool, recording):
    """Exit 2 for a wrong command line, 1 for a folder or disk that does not take the result; one plain line."""
    cases = [(2, ["simulat"], ["no subcommand \"simulat\"", "simulate"]),
             (2, ["replay", recording, "--metrics", "fll"], ["--metrics fll", "visible, full or paper"]),
             *((2, ["simulate", "--unplug", wrong], [f"--unplug {wrong}", "2@10-15"])
               for wrong in ("1@5-4", "0@5", "1@5-", "1@-5", "1", "1@x")),
             (2, ["simulate", "--unplug", "2@10"], ["no LiDAR 2"]),
             (2, ["simulate", *2 * ["--lidar", "velodyne_vlp16"], "--lidar-to", "127.0.0.1:65535"], ["65535"]),
             (2, ["simulate", *3 * ["--lidar", "velodyne_vlp16"]], ["brackets for 1 to 2 LiDARs"]),
             (1, ["simulate", "--frames", "1", "--out", recording], ["is not empty", "--force"]),
             (1, ["simulate", "--frames", "1", "--plc-bind", "192.0.2.1"], ["192.0.2.1", "an address of this host"]),
             (1, ["replay", recording, "--quiet", "--csv", "/dev/full"], ["/dev/full: ", "No space left"]),
             (1, ["replay", recording, "--quiet", "--csv", recording / "no" / "folder.csv"], ["--csv"])]
    for code, command, words in cases:
        run = subprocess.run([tool, *map(str, command)], capture_output=True, text=True, timeout=120)
        assert run.returncode == code and run.stderr.count("\n") == 1 and run.stderr[0] != "\n", (command, run)
        for word in words:
            assert word in run.stderr, (word, run.stderr)
        print(run.stderr, end="")


def check_seed(tool, folder):
    run = subprocess.run([tool, "simulate", "--frames", "1", "--seed", "-1", "--out", str(folder)],
                         capture_output=True, text=True, timeout=120)
    assert run.returncode == 2 and "--seed: -1 is negative" in run.stderr and not folder.exists(), run


def check_port_of_the_simulated_plc(tool, site):
    """--plc-port 0 takes any free port; the configuration names the one that it took."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as nobody:
        nobody.bind(("127.0.0.1", 0))
        run = subprocess.run([tool, "simulate", "--frames", "1", "--plc-port", "0", "--config-out", str(site),
                              "--lidar-to", f"127.0.0.1:{nobody.getsockname()[1]}"],
                             capture_output=True, text=True, timeout=240)
    assert run.returncode == 0, run.stderr
    port = re.search(r"the PLC listens on port (\d+)", run.stdout).group(1)
    written = re.findall(r"^port = (\d+)$", (site / "hulltrackd.toml").read_text(), re.MULTILINE)
    assert port in written and "0" not in written, (port, written)


def check_map_with_gaps(tool, daemon, folder):
    """A point that is no number is left out, and whoever uses the map is told."""
    table = folder / "hull.pcd"
    header, points = table.read_bytes().split(b"DATA binary\n", 1)
    table.write_bytes(header + b"DATA binary\n" + struct.pack("<f", float("nan")) + points[4:])
    words = f"{table}: 1 of its {len(points) // 12} points are no numbers"
    run = replay(tool, folder, "--quiet")
    assert run.returncode == 0 and words in run.stderr and run.stderr.count("\n") == 1, run.stderr
    run = subprocess.run([daemon, "--config", str(folder / "hulltrackd.toml"), "--check-config"],
                         capture_output=True, text=True, timeout=120)
    assert run.returncode == 0 and words in run.stdout and "make the map again" in run.stdout, run


def check_map_of_the_service(daemon, folder):
    (folder / "hull.pcd").write_bytes(b"solid hull\n")
    config = folder / "hulltrackd.toml"
    run = subprocess.run([daemon, "--config", str(config), "--check-config"], capture_output=True, text=True,
                         timeout=120)
    text = run.stdout + run.stderr
    assert run.returncode == 78, (run.returncode, text)
    assert f"{config}:" in text and "hull.pcd: is neither a PCD nor a PLY file" in text, text


def main():
    tool, daemon = sys.argv[1], sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        parent = pathlib.Path(name).resolve()
        good = parent / "good"
        subprocess.run([tool, "simulate", "--scenario", "berth", "--frames", "3", "--seed", "1", "--out", str(good)],
                       check=True, capture_output=True, timeout=240)
        copy = parent / "copy"

        def spoilt(spoil):
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(good, copy)
            spoil(copy)
            return copy

        check_missing_folder(tool, good, parent)
        for what, spoil, begins, words in REFUSALS:
            check_refusal(tool, spoilt(spoil), what, begins, words)
        check_cut(tool, spoilt(lambda folder: None))
        check_unfinished_turn(tool, spoilt(lambda folder: None))
        check_command_lines(tool, spoilt(lambda folder: None))
        check_seed(tool, parent / "seed")
        check_port_of_the_simulated_plc(tool, parent / "site")
        check_map_with_gaps(tool, daemon, spoilt(lambda folder: None))
        check_map_of_the_service(daemon, spoilt(lambda folder: None))


main()
