"""`hulltrack decode` of real captures against the clouds that other decoders made of the same datagrams.

Every row that the tool writes is told which slot of which datagram it stands for by counting the slots with a
return, so a row too many or too few anywhere shows. Each reference leaves some returns out (its README.txt): what
it has must be there, and of whole datagrams in its turn nothing else that it would keep.
Captures live outside the repository; exit code 77 where none is at hand."""
import array
import collections
import csv
import gzip
import math
import pathlib
import struct
import sys
import tempfile

from decode_tool import datagrams, decode

SKIPPED = 77

Row = collections.namedtuple("Row", "packet channel t_ns xyz intensity")
# How returns lie in a rotating sensor's datagram; all sizes in bytes.
Layout = collections.namedtuple("Layout", "header blocks block block_header slots slot distance lasers")
VELODYNE = Layout(0, 12, 100, 4, 32, 3, "<HB", 16)
HESAI = Layout(12, 8, 130, 2, 32, 4, "<HB", 32)
ROBOSENSE = Layout(42, 12, 100, 4, 32, 3, ">HB", 32)


def read_slot(layout, payload, block, slot):
    """(raw distance, intensity)"""
    at = layout.header + block * layout.block + layout.block_header + slot * layout.slot
    return struct.unpack_from(layout.distance, payload, at)


def raw_distance(layout, payload, block, slot):
    return read_slot(layout, payload, block, slot)[0]


def rows_of(tool, capture, folder, model, *flags):
    out = folder / "points.csv"
    run = decode(tool, capture, "--model", model, *flags, "--out", out)
    assert run.returncode == 0 and "refused" not in run.stderr, run.stderr
    with out.open(newline="") as file:
        rows = csv.reader(file)
        assert next(rows) == "packet,channel,t_ns,x,y,z,intensity".split(",")
        return [Row(int(r[0]), int(r[1]), int(r[2]), tuple(map(float, r[3:6])), int(r[6])) for r in rows]


def truth_of(folder):
    with gzip.open(folder / "truth.csv.gz", "rt", newline="") as file:
        return list(csv.DictReader(file))


def by_slot(layout, payloads, rows):
    """(packet, block, slot) -> row, in the order of the wire."""
    rows, found = iter(rows), {}
    for packet, payload in enumerate(payloads):
        for block in range(layout.blocks):
            for slot in range(layout.slots):
                distance, intensity = read_slot(layout, payload, block, slot)
                if distance == 0:
                    continue
                row = found[packet, block, slot] = next(rows)
                expected = packet, slot % layout.lasers, intensity
                assert (row.packet, row.channel, row.intensity) == expected, (row, packet, block, slot)
    assert next(rows, None) is None, "rows without a return"
    return found


def worst_of(pairs, most):
    """Largest distance of (row, x, y, z), m."""
    count, worst = 0, 0.0
    for row, xyz in pairs:
        worst = max(worst, math.dist(row.xyz, xyz))
        count += 1
    assert worst <= most, worst
    return count, worst


def check_turn(name, rows, truth, kept, whole, most):
    """`truth`: slot -> (xyz in L, intensity, channel, whether its place is to be compared). `kept`: would the
    reference keep this slot? `whole`: datagrams of which it has every slot that it keeps."""
    for slot, (_, intensity, channel, _) in truth.items():
        assert (rows[slot].intensity, rows[slot].channel) == (intensity, channel), (slot, rows[slot], truth[slot])
    ours = {slot for slot in rows if slot[0] in whole and kept(*slot)}
    theirs = {slot for slot in truth if slot[0] in whole}
    assert ours == theirs, sorted(ours ^ theirs)[:5]
    assert len(ours) > len(truth) / 2
    count, worst = worst_of(((rows[slot], t[0]) for slot, t in truth.items() if t[3]), most)
    print(f"{name}: {len(rows)} rows, {len(truth)} of the reference, {count} places, worst {worst * 1e3:.4f} mm")


def check_velodyne(tool, folder, scratch):
    capture = folder / "packets.pcap"
    payloads = [payload for _, payload in datagrams(capture)]
    rows = by_slot(VELODYNE, payloads, rows_of(tool, capture, scratch, "velodyne_vlp16", "--no-vertical-offset"))
    truth = {}
    for t in truth_of(folder):
        slot = int(t["packet_index"]), int(t["block"]), int(t["channel_slot"])
        place = tuple(float(t[axis]) for axis in "xyz")
        truth[slot] = place, int(t["intensity"]), slot[2] % 16, t["clean"] == "1"
    assert len(truth) == 14831 and sum(t[3] for t in truth.values()) == 12175

    def kept(packet, block, slot):
        raw = raw_distance(VELODYNE, payloads[packet], block, slot)
        again = block % 2 == 1 and raw == raw_distance(VELODYNE, payloads[packet], block - 1, slot)
        return raw * 0.002 > 0.3 and not again
    check_turn(folder.name, rows, truth, kept, range(454, 601), 2e-3)  # the azimuths that it drops are outside


def check_hesai(tool, folder, scratch):
    capture = folder / "packets.pcap"
    stamps, payloads = zip(*datagrams(capture))
    rows = by_slot(HESAI, payloads, rows_of(tool, capture, scratch, "hesai_xt32", "--no-firing-correction",
                                            "--calibration", folder / "PandarXT32.csv"))
    truth = {}
    for t in truth_of(folder):
        slot = int(t["packet_index"]), int(t["block"]), int(t["channel0"])
        place = float(t["y"]), -float(t["x"]), float(t["z"])  # the manual's axes: x right, y forward
        truth[slot] = place, int(t["intensity"]), slot[2], True
    assert len(truth) == 63021

    def kept(packet, block, slot):
        raw = raw_distance(HESAI, payloads[packet], block, slot)
        other = raw_distance(HESAI, payloads[packet], block ^ 1, slot)
        a, b, least = array.array("f", (raw * 0.004, other * 0.004, 0.1))
        between = array.array("f", (abs(a - b),))[0]
        return 50 <= raw * 4 <= 120_000 and (block % 2 == 1 or between >= least)
    check_turn(folder.name, rows, truth, kept, range(1598, 1899), 1e-3)  # all lasers are past azimuth zero
    for (packet, block, laser), row in rows.items():  # 50 us a pair of blocks, 1.512 us a laser (FORMAT.md)
        assert row.t_ns - stamps[packet] == 50_000 * (block // 2 - 3) + 1512 * (laser - 31), row


def check_robosense(tool, folder, scratch):
    capture = folder / "packets.pcap"
    stamps, payloads = zip(*datagrams(capture))
    data = [i for i, payload in enumerate(payloads) if payload[:2] == b"\x55\xaa"]
    index_of = {in_file: index for index, in_file in enumerate(data)}
    assert len(data) == len(payloads) - 1
    payloads = [payloads[i] for i in data]
    rows = by_slot(ROBOSENSE, payloads, rows_of(tool, capture, scratch, "robosense_helios32", "--calibration",
                                                folder / "difop.bin"))
    truth, seconds = {}, {}
    for t in truth_of(folder):
        slot = index_of[int(t["packet_index"])], int(t["block"]), int(t["channel"])
        place = tuple(float(t[axis]) for axis in "xyz")
        truth[slot] = place, int(t["intensity"]), slot[2], True
        seconds[slot] = float(t["timestamp_s"])
    assert len(truth) == 28694 + 28801

    def kept(packet, block, slot):
        return raw_distance(ROBOSENSE, payloads[packet], block, slot) > 40
    whole = {index_of[i] for i in (*range(150, 297), *range(601, 748))}
    check_turn(folder.name, rows, truth, kept, whole, 1e-3)

    # A datagram is stamped with its last firing, 31 pulses of 1.73 us into its last block; the reference's times
    # are the sensor's, to a microsecond.
    begin = {}
    for slot, t in seconds.items():
        offset = t - (rows[slot].t_ns - stamps[data[slot[0]]]) * 1e-9
        begin.setdefault(slot[0], offset)
        assert abs(offset - begin[slot[0]]) < 2e-6, slot
        assert rows[slot].t_ns <= stamps[data[slot[0]]], slot

    # Without the file the capture's own packet tells the angles, also for what comes before it.
    alone = rows_of(tool, capture, scratch, "robosense_helios32")
    assert alone == list(rows.values())


def check_ouster(tool, folder, scratch):
    capture = folder / "packets.pcap"
    sent = [(stamp, payload) for stamp, payload in datagrams(capture) if len(payload) == 8448]
    rows = rows_of(tool, capture, scratch, "ouster_os", "--calibration", folder / "metadata.json")
    packets = [i for i, (_, payload) in enumerate(sent) if struct.unpack_from("<H", payload, 2)[0] == 1796]
    assert len(packets) == 64
    rows = [row for row in rows if row.packet in set(packets)]
    truth = truth_of(folder)
    assert len(rows) == len(truth) == 107357
    for row, t in zip(rows, truth):
        stamp, payload = sent[row.packet]
        last_column = struct.unpack_from("<Q", payload, 32 + 15 * (12 + 4 * 128))[0]
        assert row.packet == packets[int(t["measurement_id"]) // 16], (row, t)
        assert (row.channel, row.intensity) == (int(t["row"]), int(t["reflectivity"])), (row, t)
        assert row.t_ns - stamp == int(t["timestamp_ns"]) - last_column, (row, t)
    _, worst = worst_of(((row, tuple(float(t[axis]) for axis in "xyz")) for row, t in zip(rows, truth)), 1e-3)
    print(f"{folder.name}: {len(rows)} of the reference, worst {worst * 1e3:.4f} mm")


def check_livox(tool, folder, scratch):
    row, = rows_of(tool, folder / "packets_zero_padded.pcap", scratch, "livox_mid360")
    truth = truth_of(folder)[3]
    assert (row.packet, row.channel, row.intensity) == (0, 3, int(truth["reflectivity"])), row
    assert math.dist(row.xyz, [float(truth[axis]) for axis in "xyz"]) < 1e-6, row
    run = decode(tool, folder / "packets.pcap", "--model", "livox_mid360", "--out", scratch / "none.csv")
    assert run.returncode == 1 and "1 were captured cut off" in run.stderr, run.stderr
    assert not (scratch / "none.csv").exists()
    print(f"{folder.name}: the one point that is stated")


CHECKS = {"velodyne_vlp16": check_velodyne, "hesai_xt32": check_hesai, "robosense_helios32": check_robosense,
          "ouster_os1-128": check_ouster, "livox_mid360": check_livox}


def main():
    tool, captures = sys.argv[1], pathlib.Path(sys.argv[2])
    present = [name for name in CHECKS if (captures / name / "truth.csv.gz").exists()]
    with tempfile.TemporaryDirectory() as scratch:
        for name in present:
            CHECKS[name](tool, captures / name, pathlib.Path(scratch))
    for name in CHECKS.keys() - present:
        print(f"{captures / name} is absent")
    return 0 if present else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
