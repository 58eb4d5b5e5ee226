"""What the tests of `hulltrack decode` share: running it, and reading captures without it."""
import struct
import subprocess


def datagrams(capture):
    """(ns, UDP payload) of a little-endian microsecond pcap of Ethernet/IPv4/UDP without options."""
    data = capture.read_bytes()
    assert struct.unpack_from("<I", data)[0] == 0xA1B2C3D4
    at = 24
    while at < len(data):
        seconds, micros, size, _ = struct.unpack_from("<IIII", data, at)
        yield seconds * 10**9 + micros * 1000, data[at + 16 + 42:at + 16 + size]
        at += 16 + size


def decode(tool, *arguments):
    return subprocess.run([tool, "decode", *map(str, arguments)], capture_output=True, text=True, timeout=120)
