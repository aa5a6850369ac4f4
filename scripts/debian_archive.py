"""Packages of Debian, from the archive that apt uses on this machine."""

import hashlib
import pathlib
import shutil
import subprocess
import urllib.error
import urllib.parse
import urllib.request

TIMEOUT = 180  # seconds without a byte


class Failure(Exception):
    pass


def archives() -> list[str]:
    """Where apt gets Debian's packages from on this machine: updates last, since they have few files."""
    command = ["apt-get", "indextargets", "--format", "$(ORIGIN) $(RELEASE) $(REPO_URI)", "Created-By: Packages"]
    targets = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    rows = sorted({tuple(line.split()) for line in targets.splitlines() if line.startswith("Debian ")},
                  key=lambda row: len(row[1]))
    found = list(dict.fromkeys(row[2].rstrip("/") for row in rows if len(row) == 3))
    if not found:
        raise Failure("apt knows no archive of Debian on this machine; run apt-get update as root")
    return found


def fetch(path: str, sha256: str, folder: pathlib.Path) -> pathlib.Path:
    """A file of the pool, kept in `folder`; the hash decides whether it is the one."""
    file = folder / pathlib.PurePosixPath(path).name
    if file.exists() and hashlib.sha256(file.read_bytes()).hexdigest() == sha256:
        return file
    problems = []
    for archive in archives():
        url = f"{archive}/{urllib.parse.quote(path)}"
        try:
            with urllib.request.urlopen(url, timeout=TIMEOUT) as response:
                data = response.read()
        except (urllib.error.URLError, OSError) as error:
            problems.append(str(error))
            continue
        if hashlib.sha256(data).hexdigest() != sha256:
            problems.append("its hash differs")
            continue
        file.write_bytes(data)
        return file
    raise Failure(f"the archive has no {path} with the hash of the list ({'; '.join(problems)}): if Debian has a newer "
                  "version, change version and hash in the list")


def unpack(package: pathlib.Path, into: pathlib.Path, part: str = ".") -> pathlib.Path:
    """The folder `into`, with what a .deb has in it, or a part of that; unpacked when it is not there."""
    if not into.exists():
        half = into.with_name(f"{into.name}.new")
        shutil.rmtree(half, ignore_errors=True)
        half.mkdir(parents=True)
        with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", str(package)], stdout=subprocess.PIPE) as unpacked:
            subprocess.run(["tar", "-x", "-C", str(half), "--no-same-owner", part], stdin=unpacked.stdout, check=True)
        half.rename(into)
    return into
