"""Reads what binaries of Windows (PE) and macOS (Mach-O), for 64-bit little-endian processors, load when they start."""

import struct

PE, MACH_O = b"MZ", b"\xcf\xfa\xed\xfe"


def kind(data: bytes) -> str | None:
    """"windows", "macos", or None."""
    if data.startswith(PE):
        return "windows"
    return "macos" if data.startswith(MACH_O) else None


def _text(data: bytes, at: int) -> str:
    return data[at:data.index(b"\0", at)].decode()


def _of_windows(data: bytes) -> list[str]:
    """The names in the table of imports."""
    (header,) = struct.unpack_from("<I", data, 0x3C)
    if data[header:header + 4] != b"PE\0\0":
        raise ValueError("it has no PE header")
    sections, options = struct.unpack_from("<H", data, header + 6)[0], struct.unpack_from("<H", data, header + 20)[0]
    optional = header + 24
    if struct.unpack_from("<H", data, optional)[0] != 0x20B:
        raise ValueError("it is not for 64-bit Windows")
    rows = [struct.unpack_from("<4I", data, optional + options + 40 * i + 8) for i in range(sections)]

    def place(address: int) -> int:
        for size, start, raw_size, raw in rows:
            if start <= address < start + max(size, raw_size):
                return address - start + raw
        raise ValueError(f"no section holds the address {address:#x}")

    (imports,) = struct.unpack_from("<I", data, optional + 112 + 8)
    found = []
    at = place(imports) if imports else None
    while at is not None:
        (name,) = struct.unpack_from("<I", data, at + 12)
        if not name:
            break
        found.append(_text(data, place(name)))
        at += 20
    return found


def _commands(data: bytes) -> list[tuple[int, int]]:
    """Number and place of each load command."""
    (count,) = struct.unpack_from("<I", data, 16)
    found, at = [], 32
    for _ in range(count):
        number, size = struct.unpack_from("<2I", data, at)
        found.append((number, at))
        at += size
    return found


def _of_macos(data: bytes) -> list[str]:
    """Of LC_LOAD_DYLIB, LC_LOAD_WEAK_DYLIB and LC_REEXPORT_DYLIB."""
    return [_text(data, at + struct.unpack_from("<I", data, at + 8)[0]) for number, at in _commands(data)
            if number in (0xC, 0x80000018, 0x8000001F)]


def loaded_by(data: bytes) -> list[str]:
    return _of_windows(data) if kind(data) == "windows" else _of_macos(data)


def oldest_macos(data: bytes) -> tuple[int, int] | None:
    """The version that LC_BUILD_VERSION asks for at least; None where it says nothing."""
    for number, at in _commands(data):
        if number == 0x32:
            (version,) = struct.unpack_from("<I", data, at + 12)
            return version >> 16, version >> 8 & 0xFF
    return None
