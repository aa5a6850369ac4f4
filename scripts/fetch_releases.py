#!/usr/bin/env python3
"""Downloads the source archives that a pip requirements file pins by version and hash, and runs nothing of them.

    fetch_releases.py SOURCES.TXT FOLDER

`pip download` would build each package's metadata, that is, fetch the build tools that it names, unpinned, and run them.
This asks the same package index as pip (PIP_INDEX_URL, pip's configuration or pip's default) for the archive with the
pinned hash. Certificates: PIP_CERT or the system's; proxies: the usual variables.
"""

import base64
import hashlib
import html.parser
import os
import pathlib
import re
import ssl
import subprocess
import sys
import urllib.error
import urllib.parse
import urllib.request
from typing import NamedTuple

TIMEOUT = 180  # seconds without a byte


class Pin(NamedTuple):
    name: str
    version: str
    sha256: str


class Failure(Exception):
    pass


def read_pins(file: pathlib.Path) -> list[Pin]:
    pins = []
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        match = re.fullmatch(r"\s*([\w.-]+)==(\S+)\s+--hash=sha256:([0-9a-f]{64})\s*", line)
        if not match:
            raise Failure(f"{file}:{number}: not of the form NAME==VERSION --hash=sha256:HASH")
        pins.append(Pin(*match.groups()))
    return pins


def pip(*arguments: str) -> str:
    command = [sys.executable, "-m", "pip", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def index_url() -> str:
    """The package index that pip uses."""
    set_by_user = os.environ.get("PIP_INDEX_URL") or next(
        filter(None, (pip("config", "get", f"{section}.index-url").strip() for section in ("download", "global"))), None)
    if set_by_user:
        return set_by_user.rstrip("/")
    # pip tells its default nowhere but in its help.
    default = re.search(r"Package Index \(default (\S+?)\)", " ".join(pip("download", "--help").split()))
    if not default:
        raise Failure("which package index pip uses is not known; set PIP_INDEX_URL")
    return default[1].rstrip("/")


def get(url: str) -> bytes:
    parts = urllib.parse.urlsplit(url)
    request = urllib.request.Request(parts._replace(netloc=parts.netloc.rpartition("@")[2], fragment="").geturl())
    if parts.username:
        user = f"{urllib.parse.unquote(parts.username)}:{urllib.parse.unquote(parts.password or '')}"
        request.add_header("Authorization", "Basic " + base64.b64encode(user.encode()).decode())
    context = ssl.create_default_context(cafile=os.environ.get("PIP_CERT"))
    with urllib.request.urlopen(request, timeout=TIMEOUT, context=context) as response:
        return response.read()


class Links(html.parser.HTMLParser):
    def __init__(self, page: str):
        super().__init__()
        self.targets: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list) -> None:
        if tag == "a":
            self.targets += [value for key, value in attrs if key == "href" and value]


def fetch(pin: Pin, index: str, folder: pathlib.Path) -> None:
    page_url = f"{index}/{re.sub(r'[-_.]+', '-', pin.name).lower()}/"
    for link in Links(get(page_url).decode()).targets:
        url = urllib.parse.urljoin(page_url, link)
        file = pathlib.PurePosixPath(urllib.parse.unquote(urllib.parse.urlsplit(url).path)).name
        if file.lower() != f"{pin.name}-{pin.version}.tar.gz".lower():
            continue
        archive = get(url)
        if hashlib.sha256(archive).hexdigest() != pin.sha256:
            raise Failure(f"{file} is not the archive that is pinned: its hash differs")
        (folder / file).write_bytes(archive)
        return
    raise Failure(f"the package index has no source archive of {pin.name} {pin.version}")


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        pins = read_pins(pathlib.Path(sys.argv[1]))
        index = index_url()
        for pin in pins:
            fetch(pin, index, pathlib.Path(sys.argv[2]))
    except (Failure, urllib.error.URLError, OSError) as error:
        print(f"{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
