"""What `cmake --install` puts where: as README and manual pages say for the prefix /usr, and for any other prefix
nowhere but below it."""
import os
import pathlib
import subprocess
import sys
import tempfile

SAMPLE = "etc/hulltrackd/hulltrackd.toml.sample"
BELOW_PREFIX = ["bin/hulltrackd", "bin/hulltrack", "lib/systemd/system/hulltrackd.service",
                "lib/sysusers.d/hulltrackd.conf", "lib/sysctl.d/60-hulltrackd.conf", "share/man/man1/hulltrack.1",
                "share/man/man5/hulltrackd.toml.5", "share/man/man8/hulltrackd.8", "share/doc/hulltrackd/icd.md"]


def install(cmake, build, prefix, destdir=None):
    environment = {key: value for key, value in os.environ.items() if key != "DESTDIR"}
    if destdir is not None:
        environment["DESTDIR"] = str(destdir)
    subprocess.run([cmake, "--install", build, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL,
                   env=environment)


def files_below(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def check(found, expected, unit, prefix):
    assert found == set(expected), (found ^ set(expected))
    text = unit.read_text(encoding="utf-8")
    for command in (f"ExecStart={prefix}/bin/hulltrackd --config /etc/hulltrackd/", f"ExecReload={prefix}/bin/hulltrackd --"):
        assert command in text, command


def main(cmake, build):
    with tempfile.TemporaryDirectory() as name:
        package = pathlib.Path(name).resolve() / "package"
        install(cmake, build, "/usr", destdir=package)
        check(files_below(package), [SAMPLE, *(f"usr/{file}" for file in BELOW_PREFIX)],
              package / "usr/lib/systemd/system/hulltrackd.service", "/usr")

        parent = pathlib.Path(name).resolve() / "elsewhere"
        install(cmake, build, parent / "opt")
        check(files_below(parent), [f"opt/{file}" for file in (SAMPLE, *BELOW_PREFIX)],
              parent / "opt/lib/systemd/system/hulltrackd.service", parent / "opt")


main(*sys.argv[1:])
