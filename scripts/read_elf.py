"""Reads from a program or a library, as the linker wrote it, where it looks for libraries and how it is hardened.

Used by tests/check_binaries.py, by check_wheel.py for a wheel, and by build_program.py. Of ELF it knows what it needs: 64 bit, little endian.
"""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
import stat
import struct

_FIXED, _SHARED = 2, 3  # e_type: programs with a fixed address; libraries, and programs that may lie anywhere
_X86_64 = 62  # e_machine
_LOAD, _DYNAMIC, _INTERPRETER = 1, 2, 3  # p_type
_STACK, _RELRO, _PROPERTY = 0x6474E551, 0x6474E552, 0x6474E553
_EXECUTE, _WRITE = 1, 2  # p_flags
_NEEDED, _STRTAB, _SYMTAB, _RPATH, _RUNPATH, _FLAGS = 1, 5, 6, 15, 29, 30  # d_tag
_VERSIONS, _VERSION_COUNT = 0x6FFFFFFE, 0x6FFFFFFF
_FLAGS_1, _GNU_HASH, _HASH = 0x6FFFFFFB, 0x6FFFFEF5, 4
_BIND_NOW, _NOW, _PIE = 8, 1, 0x08000000  # in DT_FLAGS; in DT_FLAGS_1
_FUNCTION, _LOCAL = 2, 0  # of symbols
_SYMTAB_SECTION, _DYNAMIC_SYMTAB_SECTION = 2, 11  # sh_type
_ENDBR64 = b"\xf3\x0f\x1e\xfa"
_READS_GUARD = re.compile(rb"\x64[\x48\x4c]\x8b[\x04\x0c\x14\x1c\x24\x2c\x34\x3c]\x25\x28\0\0\0")  # mov %fs:0x28,%REGISTER
_X86_FEATURES, IBT, SHSTK = 0xC0000002, 1, 2


class NotElf(Exception):
    """Of what is no ELF file that can be read."""


@dataclasses.dataclass
class Symbol:
    name: str
    address: int
    is_function: bool
    is_local: bool
    is_defined: bool


@dataclasses.dataclass
class Segment:
    kind: int
    flags: int
    offset: int
    address: int
    size: int  # in the file
    size_in_memory: int


class Elf:
    """A program, a library, or an object file of the compiler."""

    def __init__(self, data: bytes):
        if data[:6] != b"\x7fELF\x02\x01":
            raise NotElf("is no ELF file of 64 bit, little endian")
        self._data = data
        self.kind, self.machine = struct.unpack_from("<HH", data, 16)
        at, sections = struct.unpack_from("<QQ", data, 32)
        size, count, section_size, section_count = struct.unpack_from("<HHHH", data, 54)
        self._sections = [struct.unpack_from("<IIQQQQIIQQ", data, sections + i * section_size) for i in range(section_count)]
        self.segments = []
        for i in range(count):
            kind, flags, offset, address, _, in_file, in_memory = struct.unpack_from("<IIQQQQQ", data, at + i * size)
            self.segments.append(Segment(kind, flags, offset, address, in_file, in_memory))
        self._entries = self._dynamic_entries()

    def _dynamic_entries(self) -> list[tuple[int, int]]:
        entries = []
        for segment in self.segments:
            if segment.kind == _DYNAMIC:
                for at in range(segment.offset, segment.offset + segment.size, 16):
                    tag, value = struct.unpack_from("<QQ", self._data, at)
                    if tag == 0:
                        break
                    entries.append((tag, value))
        return entries

    def _values(self, tag: int) -> list[int]:
        return [value for found, value in self._entries if found == tag]

    def _offset(self, address: int) -> int:
        for segment in self.segments:
            if segment.kind == _LOAD and segment.address <= address < segment.address + segment.size:
                return address - segment.address + segment.offset
        raise NotElf(f"has nothing at the address {address:#x}")

    def _text(self, offset: int) -> str:
        return self._data[offset:self._data.index(b"\0", offset)].decode(errors="replace")

    def _dynamic_texts(self, tag: int) -> list[str]:
        return [self._text(self._offset(self._values(_STRTAB)[0]) + value) for value in self._values(tag)]

    @property
    def has_loader(self) -> bool:
        """Whether it names a loader, which a static program does not."""
        return any(segment.kind == _INTERPRETER for segment in self.segments)

    @property
    def is_program(self) -> bool:
        return self.has_loader or self.kind == _FIXED or any(value & _PIE for value in self._values(_FLAGS_1))

    @property
    def may_lie_anywhere(self) -> bool:
        return self.kind == _SHARED

    @property
    def search_path(self) -> list[str]:
        """Where the loader looks for libraries before it asks the system: the entries of RPATH and RUNPATH."""
        return [entry for text in self._dynamic_texts(_RPATH) + self._dynamic_texts(_RUNPATH) for entry in text.split(":")]

    @property
    def needed(self) -> list[str]:
        """The libraries that it asks for."""
        return self._dynamic_texts(_NEEDED)

    @property
    def needed_versions(self) -> set[str]:
        """The versions of interfaces that it asks of libraries: GLIBC_2.17."""
        found: set[str] = set()
        if not self._values(_VERSIONS):
            return found
        at, names = self._offset(self._values(_VERSIONS)[0]), self._offset(self._values(_STRTAB)[0])
        for _ in range(self._values(_VERSION_COUNT)[0]):
            _, count, _, first, following = struct.unpack_from("<HHIII", self._data, at)
            inner = at + first
            for _ in range(count):
                _, _, _, name, step = struct.unpack_from("<IHHII", self._data, inner)
                found.add(self._text(names + name))
                inner += step
            at += following
        return found

    @property
    def binds_at_once(self) -> bool:
        return any(value & _BIND_NOW for value in self._values(_FLAGS)) or \
            any(value & _NOW for value in self._values(_FLAGS_1))

    def flags_of(self, kind: int) -> int | None:
        """The flags of the first segment of that kind, None where there is none."""
        return next((segment.flags for segment in self.segments if segment.kind == kind), None)

    @property
    def is_stack_executable(self) -> bool:
        flags = self.flags_of(_STACK)
        return flags is None or bool(flags & _EXECUTE)

    @property
    def stack_bytes(self) -> int:
        """The stack that musl gives to threads, where it is larger than 128 KiB."""
        return next((segment.size_in_memory for segment in self.segments if segment.kind == _STACK), 0)

    @property
    def has_relro(self) -> bool:
        return self.flags_of(_RELRO) is not None

    @property
    def has_writable_code(self) -> bool:
        return any(segment.kind == _LOAD and segment.flags & _EXECUTE and segment.flags & _WRITE for segment in self.segments)

    @property
    def x86_features(self) -> int:
        """IBT and SHSTK, as the property of the whole file promises them."""
        notes = [(segment.offset, segment.size) for segment in self.segments if segment.kind == _PROPERTY]
        if not self.segments:  # an object file
            notes = [(section[4], section[5]) for section in self._sections if section[1] == 7]
        found = 0
        for offset, size in notes:
            name_size, _, kind = struct.unpack_from("<III", self._data, offset)
            at, end = offset + 12 + (name_size + 3) // 4 * 4, offset + size
            if kind != 5 or self._data[offset + 12:offset + 16] != b"GNU\0":
                continue
            while at + 8 <= end:
                what, length = struct.unpack_from("<II", self._data, at)
                if what == _X86_FEATURES:
                    found |= struct.unpack_from("<I", self._data, at + 8)[0]
                at += 8 + (length + 7) // 8 * 8
        return found

    def _symbols_at(self, at: int, count: int, names: int) -> list[Symbol]:
        told = []
        for i in range(count):
            name, info, _, section, address, _ = struct.unpack_from("<IBBHQQ", self._data, at + i * 24)
            told.append(Symbol(self._text(names + name), address, info & 15 == _FUNCTION, info >> 4 == _LOCAL, section != 0))
        return told

    @property
    def dynamic_symbols(self) -> list[Symbol]:
        """What it takes from others, and what it shows to them. Where it has no sections, the names are taken to follow
        the symbols, as most linkers write them."""
        if not self._values(_SYMTAB):
            return []
        for section in self._sections:
            if section[1] == _DYNAMIC_SYMTAB_SECTION:
                return self._symbols_at(section[4], section[5] // 24, self._sections[section[6]][4])
        symbols, names = self._values(_SYMTAB)[0], self._values(_STRTAB)[0]
        if names <= symbols:
            raise NotElf("has its names before its symbols")
        return self._symbols_at(self._offset(symbols), (names - symbols) // 24, self._offset(names))

    @property
    def all_symbols(self) -> list[Symbol]:
        """With those for debuggers; none where they were stripped."""
        for section in self._sections:
            if section[1] == _SYMTAB_SECTION:
                return self._symbols_at(section[4], section[5] // 24, self._sections[section[6]][4])
        return []

    @property
    def imports(self) -> set[str]:
        return {symbol.name for symbol in self.dynamic_symbols if not symbol.is_defined and symbol.name}

    @property
    def code(self) -> bytes:
        return b"".join(self._data[segment.offset:segment.offset + segment.size] for segment in self.segments
                        if segment.kind == _LOAD and segment.flags & _EXECUTE)

    @property
    def has_stack_protector(self) -> bool:
        """Whether it takes the function that reports an overwritten stack from elsewhere; or, since zig brings that along,
        whether its code reads the guard, where that can be told (x86-64)."""
        return bool(self.imports & {"__stack_chk_fail", "__stack_chk_guard"}) or \
            self.machine == _X86_64 and _READS_GUARD.search(self.code) is not None

    def begins_with_endbr(self, symbol: Symbol) -> bool:
        offset = self._offset(symbol.address)
        return self._data[offset:offset + 4] == _ENDBR64


def read(file: pathlib.Path) -> Elf | None:
    """None where the file is not ELF."""
    with file.open("rb") as opened:
        if opened.read(4) != b"\x7fELF":
            return None
    return Elf(file.read_bytes())


def _others_may_write(folder: str) -> bool:
    """Whether anybody may make that folder, or put files into it."""
    for place in (pathlib.Path(folder), *pathlib.Path(folder).parents):
        try:
            mode = os.stat(place).st_mode
        except OSError:
            continue
        if mode & stat.S_IWOTH:
            return True
    return False


def search_path_faults(elf: Elf) -> list[str]:
    """Entries from which somebody else's library could be loaded."""
    found = []
    for entry in elf.search_path:
        if not entry:
            found.append("has an empty entry in RUNPATH, which stands for the current folder")
        elif re.match(r"\$(ORIGIN|\{ORIGIN\})(/|$)", entry):
            continue
        elif not entry.startswith("/"):
            found.append(f"has {entry!r} in RUNPATH, which is relative to the current folder")
        elif _others_may_write(entry):
            found.append(f"has {entry!r} in RUNPATH, which everybody may write to")
    return found + [f"asks for {name!r}, which is relative to the current folder" for name in elf.needed
                    if "/" in name and not name.startswith("/")]


def hardening_faults(elf: Elf, is_fortified: bool) -> list[str]:
    """What lacks of a hardened build. `is_fortified`: it has calls of which the compiler knows the size of the target."""
    found = []
    if elf.is_program and not elf.may_lie_anywhere:
        found.append("is a program with a fixed address (no PIE)")
    if elf.is_stack_executable:
        found.append("has a stack that may be executed (GNU_STACK)")
    if elf.has_writable_code:
        found.append("has code that may be written to")
    if not elf.has_relro:
        found.append("has no GNU_RELRO")
    if not elf.binds_at_once:
        found.append("has no BIND_NOW")
    imports = elf.imports
    if not elf.has_stack_protector:
        found.append("has no stack protector: no call of __stack_chk_fail (-fstack-protector-strong)")
    if is_fortified and not any(re.fullmatch(r"__\w+_chk", name) for name in imports):
        found.append("imports none of __memcpy_chk and the like (-D_FORTIFY_SOURCE)")
    if elf.machine == _X86_64:
        bare = functions_without_endbr(elf)
        if bare:
            found.append(f"has functions that do not begin with endbr64 (-fcf-protection), {bare[0]} the first of {len(bare)}")
    return found


def mathematics_faults(elf: Elf) -> list[str]:
    """The functions that it does not take from glibc, with which other builds compute, but brings with it."""
    lacking = {"sin", "cos", "tan", "exp", "log"} - elf.imports
    return [f"does not take {', '.join(sorted(lacking))} from glibc but from zig's compiler-rt: the linker was given that "
            "before glibc, or something needs what scripts/zig_compiler.sh does not give"] if lacking else []


def functions_without_endbr(elf: Elf) -> list[str]:
    """Those that others call through a pointer: what a library shows, and the main function of a program."""
    shown = [symbol for symbol in elf.dynamic_symbols if symbol.is_defined and symbol.is_function and symbol.address]
    shown += [symbol for symbol in elf.all_symbols if symbol.name == "main" and symbol.is_function and symbol.address]
    if not shown:  # of a stripped program that shows none it can be told only whether any function begins so
        return [] if elf.is_program and _ENDBR64 in elf.code else ["none that is shown"]
    # What the C library's own start files bring along is not ours.
    return [symbol.name for symbol in shown if symbol.name not in ("_init", "_fini", "_start")
            and not elf.begins_with_endbr(symbol)]
