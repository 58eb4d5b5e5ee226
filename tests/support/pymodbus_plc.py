#!/usr/bin/python3
"""A PLC that is not libmodbus: serves joints, logs what the service writes.

It presents the read block of hulltrackd.toml(5) from constants or from a table such as a recording's
plc.csv, and logs every write that covers the 40 registers of the write block with the time of its arrival.
Registers are packed and unpacked here with struct, independently of the service's own codec.

Standard output: `port N` as soon as it listens, then, with --log -, the log. Ends with exit code 0 when
standard input closes or after --seconds. Lines understood on standard input:

    start NS          the table's epoch is presented at CLOCK_MONOTONIC = NS (or `now`)
    joints D,S,L      present these from now on (m, deg, deg)
    command N         the command word
    heartbeat off|on  freeze the heartbeat, let it run again

Until `start`, and before and after the table, the nearest row is presented; the heartbeat always runs.
Needs python3-pymodbus, python3-serial, python3-serial-asyncio (Debian 12).
"""

import argparse
import asyncio
import bisect
import csv
import logging
import os
import struct
import sys
import threading
import time

from pymodbus.datastore import ModbusServerContext, ModbusSlaveContext
from pymodbus.datastore.store import BaseModbusDataBlock
from pymodbus.server.async_io import ModbusTcpServer

WRITE_BLOCK = (  # name, offset, kind: w = one register, u = uint32, r = real; register layout of the write block
    ("heartbeat", 0, "w"), ("health", 1, "w"), ("state", 2, "w"), ("faults", 3, "w"), ("frame", 4, "u"),
    ("x", 6, "r"), ("y", 8, "r"), ("z", 10, "r"), ("roll", 12, "r"), ("pitch", 14, "r"), ("yaw", 16, "r"),
    ("q1", 18, "r"), ("mean", 20, "r"), ("median", 22, "r"), ("q3", 24, "r"), ("rms", 26, "r"),
    ("matched", 28, "u"), ("age_ms", 30, "r"), ("sigma_t", 32, "r"), ("sigma_r", 34, "r"),
    ("processing_ms", 36, "r"), ("command", 38, "w"), ("heartbeat_copy", 39, "w"))
WRITE_BLOCK_SIZE = 40
# Where the bytes A B C D (A most significant) of a 32-bit value stand on the wire.
WORD_ORDERS = {"ABCD": (0, 1, 2, 3), "CDAB": (2, 3, 0, 1), "BADC": (1, 0, 3, 2), "DCBA": (3, 2, 1, 0)}


def to_registers(four_bytes, order):
    wire = bytes(four_bytes[i] for i in WORD_ORDERS[order])
    return list(struct.unpack(">HH", wire))


def from_registers(registers, order):
    wire = struct.pack(">HH", *registers)
    value = bytearray(4)
    for at, i in enumerate(WORD_ORDERS[order]):
        value[i] = wire[at]
    return bytes(value)


class JointTable:
    """Rows of (t_ns, (d_x, theta_r, theta_p)), interpolated linearly, constant beyond its ends."""

    def __init__(self, rows):
        self.times = [t for t, _ in rows]
        self.joints = [j for _, j in rows]

    @classmethod
    def read(cls, path):
        with open(path, newline="", encoding="ascii") as file:
            rows = [(int(row["t_ns"]), tuple(float(row[key]) for key in ("d_x", "theta_r", "theta_p")))
                    for row in csv.DictReader(file)]
        if not rows:
            raise SystemExit(f"{path}: no rows")
        return cls(rows)

    def at(self, t_ns):
        after = bisect.bisect_right(self.times, t_ns)
        if after == 0:
            return self.joints[0]
        if after == len(self.times):
            return self.joints[-1]
        t0, t1 = self.times[after - 1], self.times[after]
        part = (t_ns - t0) / (t1 - t0)
        return tuple(a + part * (b - a) for a, b in zip(self.joints[after - 1], self.joints[after]))


class Plc(BaseModbusDataBlock):
    """Holding registers of a PLC: the read block changes with its cycle, everything else is memory."""

    def __init__(self, args, table, log):
        self.args = args
        self.table = table
        self.log = log
        self.epoch_ns = args.epoch_ns if args.epoch_ns is not None else table.times[0]
        self.start_ns = None  # CLOCK_MONOTONIC at which the epoch is presented
        self.ready_ns = time.monotonic_ns()
        self.requests = 0
        self.frozen_heartbeat = None
        self.command = 0
        self.writes = 0
        self.address = 0
        self.default_value = 0
        self.values = [0] * 65536

    # -- what pymodbus calls (its names)

    def validate(self, address, count=1):
        return 0 <= address and address + count <= len(self.values)

    def getValues(self, address, count=1):
        base = self.args.read_base
        block_size = max(8, self.args.tail + 1)
        if address < base + block_size and address + count > base:
            self.present()
        return self.values[address:address + count]

    def setValues(self, address, values):
        now_ns, utc_ns = time.monotonic_ns(), time.time_ns()
        self.values[address:address + len(values)] = values
        base = self.args.write_base
        if address <= base and address + len(values) >= base + WRITE_BLOCK_SIZE:
            self.writes += 1
            self.log_write(now_ns, utc_ns, self.values[base:base + WRITE_BLOCK_SIZE])

    # -- the read block

    def cycle(self):
        """Time of the current PLC cycle, and its number. Without cycles: now, and the number of the request."""
        now_ns = time.monotonic_ns()
        if self.args.cycle_ms <= 0:
            self.requests += 1
            return now_ns, self.requests
        cycle_ns = int(self.args.cycle_ms * 1e6)
        number = (now_ns - self.ready_ns) // cycle_ns
        return self.ready_ns + number * cycle_ns, number

    def heartbeat(self):
        return self.frozen_heartbeat if self.frozen_heartbeat is not None else self.cycle()[1] & 0xFFFF

    def present(self):
        time_ns, number = self.cycle()
        elapsed_ns = 0 if self.start_ns is None else time_ns - self.start_ns
        heartbeat = self.frozen_heartbeat if self.frozen_heartbeat is not None else number & 0xFFFF
        base = self.args.read_base
        for offset, joint in zip((0, 2, 4), self.table.at(self.epoch_ns + elapsed_ns)):
            raw = joint / self.args.read_scale
            four = struct.pack(">f", raw) if self.args.read_type == "float32" else struct.pack(">i", round(raw))
            self.values[base + offset:base + offset + 2] = to_registers(four, self.args.word_order)
        self.values[base + 6] = heartbeat
        self.values[base + 7] = self.command
        if self.args.tail >= 0:
            self.values[base + self.args.tail] = heartbeat

    # -- the write block

    def decoded(self, registers):
        fields = {}
        for name, offset, kind in WRITE_BLOCK:
            if kind == "w":
                fields[name] = registers[offset]
                continue
            four = from_registers(registers[offset:offset + 2], self.args.word_order)
            if kind == "u":
                fields[name] = struct.unpack(">I", four)[0]
            elif self.args.encoding == "float32":
                fields[name] = struct.unpack(">f", four)[0]
            else:
                fields[name] = struct.unpack(">i", four)[0] / 10000
        return fields

    def log_header(self):
        if self.log:
            print("mono_ns,utc_ns," + ",".join(name for name, _, _ in WRITE_BLOCK), file=self.log, flush=True)

    def log_write(self, now_ns, utc_ns, registers):
        if self.log:
            values = ",".join(f"{value:.9g}" if isinstance(value, float) else str(value)
                              for value in self.decoded(registers).values())
            print(f"{now_ns},{utc_ns},{values}", file=self.log, flush=True)

    # -- standard input

    def obey(self, line):
        word, _, rest = line.strip().partition(" ")
        if word == "start":
            self.start_ns = time.monotonic_ns() if rest == "now" else int(rest)
        elif word == "joints":
            self.table = JointTable([(0, parse_joints(rest))])
        elif word == "command":
            self.command = int(rest, 0) & 0xFFFF
        elif word == "heartbeat":
            self.frozen_heartbeat = None if rest == "on" else self.heartbeat()
        elif word:
            raise ValueError(f"not understood: {line.strip()}")


def parse_joints(text):
    joints = tuple(float(part) for part in text.split(","))
    if len(joints) != 3:
        raise ValueError(f"three numbers D_X,SLEW,LUFF expected, not {text}")
    return joints


def read_standard_input(loop, plc, finished):
    """Runs on a thread. os.read() instead of sys.stdin: a thread blocked in it does not hinder the exit."""
    rest = b""
    while chunk := os.read(0, 4096):
        *lines, rest = (rest + chunk).split(b"\n")
        for line in lines:
            try:
                plc.obey(line.decode())
            except ValueError as error:
                print(f"pymodbus_plc: {error}", file=sys.stderr, flush=True)
    loop.call_soon_threadsafe(finished.set)


async def serve(args, plc):
    slaves = ModbusSlaveContext(di=plc, co=plc, hr=plc, ir=plc, zero_mode=True)
    context = ModbusServerContext(slaves={args.unit: slaves}, single=False)
    server = ModbusTcpServer(context, address=(args.host, args.port), allow_reuse_address=True)
    serving = asyncio.ensure_future(server.serve_forever())
    await asyncio.wait({serving, server.serving}, return_when=asyncio.FIRST_COMPLETED)
    if serving.done():
        serving.result()  # raises: port in use
    print(f"port {server.server.sockets[0].getsockname()[1]}", flush=True)
    plc.log_header()

    finished = asyncio.Event()
    threading.Thread(target=read_standard_input, args=(asyncio.get_running_loop(), plc, finished),
                     daemon=True).start()
    try:
        await asyncio.wait_for(finished.wait(), args.seconds)
    except asyncio.TimeoutError:
        pass
    serving.cancel()
    server.server.close()


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=0, help="0 = any free port, printed as `port N`")
    parser.add_argument("--unit", type=int, default=1)
    parser.add_argument("--read-base", type=int, default=0)
    parser.add_argument("--write-base", type=int, default=100)
    parser.add_argument("--word-order", choices=WORD_ORDERS, default="ABCD", help="of both blocks")
    parser.add_argument("--read-type", choices=("float32", "int32"), default="float32")
    parser.add_argument("--read-scale", type=float, default=1.0, help="m or deg per count of the joints")
    parser.add_argument("--encoding", choices=("float32", "int32"), default="float32", help="of the write block")
    parser.add_argument("--tail", type=int, default=-1, help="offset of the heartbeat's copy, -1 = none")
    parser.add_argument("--cycle-ms", type=float, default=10.0,
                        help="the PLC's cycle; 0 = values of the very moment of each request")
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--joints", type=parse_joints, default=(0.0, 0.0, 0.0), metavar="D_X,SLEW,LUFF")
    source.add_argument("--joints-csv", metavar="FILE", help="columns t_ns,d_x,theta_r,theta_p; others are ignored")
    parser.add_argument("--epoch-ns", type=int, help="t_ns that `start` refers to; default: the first row's")
    parser.add_argument("--start-monotonic-ns", type=int, help="as the line `start NS`")
    parser.add_argument("--log", metavar="FILE", help="CSV of the writes, - = standard output")
    parser.add_argument("--seconds", type=float, help="end after so long")
    return parser.parse_args()


def main():
    args = parse_arguments()
    logging.getLogger("pymodbus").setLevel(logging.CRITICAL)  # it reports every connection cancelled at the end
    table = JointTable.read(args.joints_csv) if args.joints_csv else JointTable([(0, args.joints)])
    log = sys.stdout if args.log == "-" else open(args.log, "w", encoding="ascii") if args.log else None
    plc = Plc(args, table, log)
    plc.start_ns = args.start_monotonic_ns
    try:
        asyncio.run(serve(args, plc))
    except OSError as error:
        sys.exit(f"pymodbus_plc: cannot listen on {args.host} port {args.port}: {error.strerror}")
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
