"""The unit under a real systemd: boots one in a container and runs service_manager_probe.py inside it.

The container's root is a temporary folder with the host's /usr (read-only), the unit with its program's path
replaced as the installation does, and a loopback of its own. Needs root, systemd-nspawn and cgroups that it may
write; skipped (77) where there are none, and where the machine or the binary is too slow for the watchdog. Memory
limits are not tried: the container may have no such controller.
"""
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

# One corner of the room is the ship: three walls fix a pose, and a frame costs a quarter of the whole room's.
REGION = (0.0, 0.0, -9.0, 19.0, 12.0, 0.0)
CONFIG = f"""
[plc]
host = "127.0.0.1"
port = 1502

[[lidar]]
model = "velodyne_vlp16"
bind = "0.0.0.0"
port = 2368
mount = {{ xyz = [0.2, -0.3, 0.5], rpy_deg = [35.0, 20.0, 10.0] }}

[hull]
map = "room.pcd"
region = {list(REGION)}
"""
PROBE_UNIT = """
[Unit]
Requires=basic.target dbus.service
After=basic.target dbus.service
[Service]
Type=oneshot
ExecStartPre=systemd-sysusers hulltrackd.conf
ExecStart=/usr/bin/python3 /opt/service_manager_probe.py
StandardOutput=append:/root/probe.txt
StandardError=append:/root/probe.txt
ExecStopPost=/bin/sh -c 'echo $EXIT_STATUS > /root/exit_status; exec systemctl poweroff -ff'
"""
PASSWD = "root:x:0:0::/root:/bin/sh\nmessagebus:x:100:100::/:/usr/sbin/nologin\n"
GROUP = "root:x:0:\nmessagebus:x:100:\nsystemd-journal:x:101:\n"
# Nothing in the container waits for a network, and nothing needs one. The user is made as the manual says, not by
# the boot.
MASKED = ("systemd-networkd.service", "systemd-networkd-wait-online.service", "systemd-resolved.service",
          "systemd-sysusers.service")
# A sanitized binary looks for leaks as its process ends, by ptrace, which the locked-down unit does not allow.
DROP_IN = "[Service]\nEnvironment=ASAN_OPTIONS=detect_leaks=0\n"
PATIENCE_S = 400


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def cut_to_region(pcd):
    """`pcd`: binary, x, y and z as floats."""
    header, body = pcd.read_bytes().split(b"DATA binary\n", 1)
    points = list(struct.iter_unpack("<3f", body))
    kept = [p for p in points if all(low <= v <= high for low, v, high in zip(REGION, p, REGION[3:]))]
    for key in (b"WIDTH", b"POINTS"):
        header = header.replace(b"%s %d" % (key, len(points)), b"%s %d" % (key, len(kept)))
    pcd.write_bytes(header + b"DATA binary\n" + b"".join(struct.pack("<3f", *p) for p in kept))


def furnish(root, hulltrackd, room_lidar, support, unit):
    for folder in ("usr", "proc", "sys", "dev", "run", "tmp", "var/tmp", "root", "opt", "etc/hulltrackd"):
        (root / folder).mkdir(parents=True)
    for link in ("bin", "sbin", "lib", "lib64"):
        (root / link).symlink_to(f"usr/{link}")
    shutil.copy("/usr/lib/os-release", root / "etc/os-release")
    write(root / "etc/passwd", PASSWD)
    write(root / "etc/group", GROUP)
    (root / "etc/sysusers.d").mkdir()
    shutil.copy(unit.with_suffix(".sysusers"), root / "etc/sysusers.d/hulltrackd.conf")
    write(root / "etc/machine-id", "uninitialized\n")
    units = root / "etc/systemd/system"
    text = unit.read_text(encoding="utf-8")
    write(units / unit.name, text.replace("=/usr/bin/hulltrackd", "=/opt/hulltrackd"))
    write(units / f"{unit.name}.d/sanitizer.conf", DROP_IN)
    write(units / "probe.service", PROBE_UNIT)
    for name in MASKED:
        (units / name).symlink_to("/dev/null")
    here = pathlib.Path(__file__).parent
    for program in (hulltrackd, room_lidar, support / "service_process.py", support / "pymodbus_plc.py",
                    here / "service_manager_probe.py"):
        shutil.copy(program, root / "opt")
    room = root / "etc/hulltrackd/room.pcd"
    subprocess.run([room_lidar, "--map", room], check=True)
    cut_to_region(room)
    write(root / "etc/hulltrackd/hulltrackd.toml", CONFIG)
    subprocess.run(["chmod", "-R", "a+rX", root], check=True)  # the service is not root


def boot(root):
    """Returns what the console shows, and whether the container was done in time."""
    command = ["systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--private-network", "--capability=all",
               "--system-call-filter=@memlock bpf @keyring perf_event_open", f"--directory={root}",
               "--bind-ro=/usr", "--console=pipe", f"--machine=hulltrackd-test-{os.getpid()}", "--boot",
               "systemd.unit=probe.service"]
    environment = dict(os.environ, SYSTEMD_NSPAWN_UNIFIED_HIERARCHY="1")
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                              check=False, timeout=PATIENCE_S, env=environment)
        return done.stdout + done.stderr, True
    except subprocess.TimeoutExpired as expired:  # which has killed nspawn and with it the container
        return (expired.stdout or b"").decode(errors="replace"), False


def main(hulltrackd, room_lidar, support, unit):
    if os.geteuid() != 0 or shutil.which("systemd-nspawn") is None:
        print("needs root and systemd-nspawn (package systemd-container): skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve() / "root"
        root.mkdir(mode=0o755)
        pathlib.Path(folder).chmod(0o755)
        furnish(root, *map(pathlib.Path, (hulltrackd, room_lidar, support, unit)))
        console, done = boot(root)
        report = root / "root/probe.txt"
        if not report.exists():
            print(console[-3000:] + "\nno systemd came up in a container here: skipped")
            return 77
        text = report.read_text(encoding="utf-8", errors="replace")
        print(text)
        if not done and "... FAIL" not in text and "... ERROR" not in text:
            print(f"not done after {PATIENCE_S} s, though nothing failed: the machine is too slow: skipped")
            return 77
        status = root / "root/exit_status"
        code = status.read_text(encoding="ascii").strip() if status.exists() else ""
    return int(code) if code in ("0", "77") else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
