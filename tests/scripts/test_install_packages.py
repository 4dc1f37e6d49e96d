#!/usr/bin/python3
"""What scripts/install-packages says meanwhile, with an apt that installs nothing."""
import os
import pty
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "scripts" / "install-packages"
APT = """#!/bin/sh
case " $* " in
  *" -qq "*) ;;
  *" update "*) echo "Get:1 bookworm" ;;
  *" --assume-no "*)
    echo "0 upgraded, 2 newly installed, 0 to remove."
    echo "Need to get 593 kB of archives."
    echo "Abort."
    exit 1 ;;
  *) echo "Get:2 cmake" ;;
esac
case " $* " in *" install "*) echo "Unpacking cmake" ;; esac
"""
#: The locks of the lists and of the packages, while somebody is at them: until the file "rests" has two lines.
LOCKED = """#!/bin/sh
case " $* " in
  *" DPkg::Lock::Timeout="[1-9]*) ;;
  *" update "*)
    [ "$(wc -l < "${0%/*}/rests")" -ge 2 ] || { echo "E: Could not get lock /var/lib/apt/lists/lock" >&2; exit 100; } ;;
  *) echo "E: Could not get lock /var/lib/dpkg/lock-frontend" >&2; exit 100 ;;
esac
"""
SLEEP = """#!/bin/sh
echo "$1" >> "${0%/*}/rests"
"""
BROKEN = """#!/bin/sh
echo "E: Malformed entry 1 in list file /etc/apt/sources.list" >&2
exit 100
"""
NOTHING = "#!/bin/sh\n"
DEBIAN_ON_ARM = """#!/bin/sh
cat <<'EOF'
config-files clang clang-x.org
installed g++ c++-compiler, g++-aarch64-linux-gnu (= 4:12.2.0-3)
installed git git-completion, git-core
installed shellcheck
EOF
"""
SUDO = """#!/bin/sh
[ "$1" != -n ] || shift
exec "$@"
"""


class Installation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name, text in (("apt-get", APT), ("dpkg-query", NOTHING), ("sudo", SUDO)):
            self.write_program(name, text)
        self.environment = {**os.environ, "PATH": f"{folder.name}:{os.environ['PATH']}"}

    def write_program(self, name, text):
        program = self.folder / name
        program.write_text(text)
        program.chmod(0o755)

    def run_program(self, *arguments, **streams):
        return subprocess.run([str(PROGRAM), *(arguments or ["build"])], env=self.environment, stdin=subprocess.DEVNULL,
                              timeout=60, check=True, **streams)

    def test_tells_a_log_how_much_is_to_come_and_nothing_more(self):
        done = self.run_program(capture_output=True, text=True)
        self.assertEqual(done.stdout, "")
        installing, *told = done.stderr.splitlines()
        self.assertIn("installing g++ cmake", installing)
        self.assertEqual(told, ["0 upgraded, 2 newly installed, 0 to remove.", "Need to get 593 kB of archives."])

    def test_shows_a_terminal_what_apt_shows(self):
        ours, terminal = pty.openpty()
        done = self.run_program(stdout=subprocess.PIPE, stderr=terminal)
        os.close(terminal)
        shown = os.read(ours, 65536).decode()
        os.close(ours)
        self.assertEqual(done.stdout, b"")
        for text in ("Get:1 bookworm", "Get:2 cmake", "Unpacking cmake"):
            self.assertIn(text, shown)

    def test_counts_what_an_installed_package_provides(self):
        self.write_program("dpkg-query", DEBIAN_ON_ARM)
        done = self.run_program("-n", "check", capture_output=True, text=True)
        self.assertEqual(done.stdout.split(), ["clang", "clang-tidy", "clang-format", "libclang-rt-14-dev",
                                               "python3-opencv", "python3-torch"])

    def test_waits_for_the_upgrades_of_a_machine_that_was_just_started(self):
        rests = self.folder / "rests"
        rests.touch()
        self.write_program("apt-get", LOCKED)
        self.write_program("sleep", SLEEP)
        self.run_program(capture_output=True)
        self.assertEqual(rests.read_text(), "10\n10\n")

    def test_fails_at_once_where_waiting_does_not_help(self):
        self.write_program("apt-get", BROKEN)
        self.write_program("sleep", BROKEN)
        with self.assertRaises(subprocess.CalledProcessError) as failure:
            self.run_program(capture_output=True, text=True)
        self.assertIn("E: Malformed entry 1", failure.exception.stderr)


if __name__ == "__main__":
    unittest.main()
