"""One recording folder of several LiDARs on the same boom, made of one simulation a model.

The same scenario and seed give the same ship, loader and PLC whatever the LiDAR is, so that the captures can
be laid together by their stamps: the first LiDAR's datagrams go to its port, the next one's to the port after
it. Captures as `hulltrack simulate` writes them: classic pcap, Ethernet, IPv4 without options, UDP.
"""
import heapq
import re
import shutil
import struct

FILE_HEADER, RECORD_HEADER = 24, struct.Struct("<IIII")
UDP_DESTINATION, UDP_CHECKSUM = 36, 40  # offsets in an Ethernet frame
FIRST_PORT = 2368


def records(capture, port):
    """(seconds, fraction, record with its header), sent to `port`; a checksum of 0 means none."""
    with open(capture, "rb") as file:
        file.seek(FILE_HEADER)
        while header := file.read(RECORD_HEADER.size):
            seconds, fraction, captured, _ = RECORD_HEADER.unpack(header)
            frame = bytearray(file.read(captured))
            struct.pack_into(">H", frame, UDP_DESTINATION, port)
            struct.pack_into(">H", frame, UDP_CHECKSUM, 0)
            yield seconds, fraction, header + frame


def merged_config(recordings):
    """The first one's configuration with the [[lidar]] tables of all, each with a name and port of its own."""
    table = re.compile(r"\[\[lidar\]\]\n.*?(?=^\[\w)", re.DOTALL | re.MULTILINE)
    texts = [(recording / "hulltrackd.toml").read_text(encoding="utf-8") for recording in recordings]
    lidars = ""
    for i, text in enumerate(texts):
        lidar = table.search(text).group().replace('name = "boom"', f'name = "boom{i}"')
        lidars += lidar.replace(f"port = {FIRST_PORT}", f"port = {FIRST_PORT + i}")
    return table.sub(lambda _: lidars, texts[0], count=1)


def merge(recordings, out):
    out.mkdir()
    first = recordings[0]
    for name in ("plc.csv", "truth.csv", "hull.pcd", "quay.pcd"):
        shutil.copy(first / name, out)
    for other in recordings[1:]:
        for name in ("plc.csv", "truth.csv"):
            assert (other / name).read_bytes() == (first / name).read_bytes(), f"{other / name} differs"
    (out / "hulltrackd.toml").write_text(merged_config(recordings), encoding="utf-8")
    with open(out / "lidar.pcap", "wb") as file:
        file.write((first / "lidar.pcap").read_bytes()[:FILE_HEADER])
        for record in heapq.merge(*(records(recording / "lidar.pcap", FIRST_PORT + i)
                                    for i, recording in enumerate(recordings))):
            file.write(record[2])
