"""The unit file holds what the service promises: systemd finds no fault in it, it stays locked down,
and it restarts, watches and gives up as the manual says. Skipped (77) where systemd-analyze is missing."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MAX_EXPOSURE = 1.5  # of `systemd-analyze security`; chrony's restricted unit has 2.1


def analyze(*arguments):
    return subprocess.run(["systemd-analyze", *arguments], capture_output=True, text=True, check=False)


def main(unit_path, program):
    if shutil.which("systemd-analyze") is None:
        print("systemd-analyze is not installed: skipped")
        return 77
    text = pathlib.Path(unit_path).read_text(encoding="utf-8")
    for promise in ("Type=notify", "WatchdogSec=1", "Restart=on-failure", "RestartPreventExitStatus=78",
                    "ExecReload=/usr/bin/hulltrackd --reload", "RuntimeDirectoryPreserve=restart",
                    "OOMPolicy=continue", "TimeoutStopSec=5"):
        assert promise in text.splitlines(), f"{unit_path}: lacks {promise}"

    with tempfile.TemporaryDirectory() as folder:
        # verify looks for the program, which may not be installed yet.
        unit = pathlib.Path(folder) / "hulltrackd.service"
        unit.write_text(text.replace("/usr/bin/hulltrackd", program), encoding="utf-8")
        verify = analyze("verify", "--man=no", str(unit))
        assert verify.returncode == 0 and "hulltrackd.service" not in verify.stderr, verify.stderr

        security = analyze("security", "--offline=yes", "--no-pager", str(unit)).stdout
    exposure = re.search(r"exposure level for \S+: ([0-9.]+)", security)
    assert exposure, security
    print(f"exposure {exposure.group(1)} (limit {MAX_EXPOSURE})")
    assert float(exposure.group(1)) <= MAX_EXPOSURE, security
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
