"""`hulltrack probe` on captures of every simulated model, live with a PLC, and where there is nothing to find."""
import pathlib
import re
import socket
import subprocess
import sys
import tempfile

MODELS = ["velodyne_vlp16", "ouster_os", "hesai_xt32", "robosense_helios32", "livox_mid360"]
# A Mid-360's datagrams are those of a HAP; an Ouster's need its metadata.
VERDICTS = {"livox_mid360": "Livox: livox_mid360 or livox_hap", "ouster_os": "Ouster: ouster_os"}


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def run(tool, *arguments):
    return subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True, timeout=120)


def check_captures(tool, folder):
    for model in MODELS:
        recording = folder / model
        made = run(tool, "simulate", "--lidar", model, "--frames", 12, "--out", recording)
        assert made.returncode == 0, made.stderr
        told = run(tool, "probe", recording / "lidar.pcap")
        assert told.returncode == 0, told.stderr
        vendor = model.split("_")[0]
        verdict = re.search(r"verdict +(.*)", told.stdout)[1]
        assert verdict.lower().startswith(vendor), told.stdout
        assert model in verdict, told.stdout
        assert verdict.startswith(VERDICTS.get(model, "")), told.stdout
        assert "192.168.1.201" in told.stdout and re.search(r"next +\S", told.stdout), told.stdout
        if model == "velodyne_vlp16":
            assert "600 rpm" in told.stdout and "lost         0.0 %" in told.stdout, told.stdout
    print(f"{len(MODELS)} models named from their captures")


def check_live(tool, folder):
    plc, lidar = free_port(socket.SOCK_STREAM), free_port(socket.SOCK_DGRAM)
    sender = subprocess.Popen(
        [tool, "simulate", "--lidar", "hesai_xt32", "--joints", "3.5,90,1", "--seconds", "30", "--plc-port", str(plc),
         "--lidar-to", f"127.0.0.1:{lidar}"], stdout=subprocess.PIPE, text=True)
    try:
        for line in sender.stdout:  # it listens before it says so
            if "the PLC listens" in line:
                break
        told = run(tool, "probe", "--port", lidar, "--seconds", 2, "--plc", f"127.0.0.1:{plc}")
    finally:
        sender.terminate()
        sender.communicate(timeout=60)
    assert told.returncode == 0, told.stderr + told.stdout
    assert re.search(r"joints in float32 with word order (ABCD|.* or ABCD|ABCD or .*)", told.stdout), told.stdout
    assert re.search(r"verdict +Hesai: hesai_xt32", told.stdout), told.stdout
    print("a sensor and a PLC recognised live")


def check_models(tool):
    listed = run(tool, "models")
    assert listed.returncode == 0, listed.stderr
    assert max(map(len, listed.stdout.splitlines())) <= 120, listed.stdout
    row = next(line for line in listed.stdout.splitlines() if line.startswith("robosense_helios32"))
    assert re.search(r"6699 +7788 +180 m +receive +PTP, GPS +DIFOP packet \(optional\)", row), row


def check_nothing(tool, folder):
    silent = run(tool, "probe", "--port", free_port(socket.SOCK_DGRAM), "--seconds", 0.2)
    assert silent.returncode == 1 and "nothing arrived on UDP port" in silent.stderr, silent.stderr
    refused = run(tool, "probe", "--seconds", 0.2, "--plc", f"127.0.0.1:{free_port(socket.SOCK_STREAM)}")
    assert refused.returncode == 1 and "the PLC at 127.0.0.1" in refused.stderr, refused.stderr
    wrong = run(tool, "probe", "--plc", "127.0.0.1:x")
    assert wrong.returncode == 2 and "give HOST or HOST:PORT" in wrong.stderr, wrong.stderr
    broken = folder / "broken.pcap"
    broken.write_bytes(b"no capture")
    assert run(tool, "probe", broken).returncode == 1


def main():
    tool = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_models(tool)
        check_nothing(tool, folder)
        check_captures(tool, folder)
        check_live(tool, folder)


main()
