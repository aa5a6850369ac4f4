"""Changes files at random: bits, bytes, numbers, words, pieces of them and of others."""

import random
import re

NUMBERS = [b"0", b"-1", b"1e308", b"-1e308", b"1e-320", b"nan", b"inf", b"9223372036854775807", b"-9223372036854775808",
           b"4294967295", b"2147483648", b"65536", b"0.1e", b"1" * 400, b"--1", b"0x10", b"1_000", b""]
BINARY = [0, 1, 0x7F, 0x80, 0xFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0xFFFFFFFE]
BITS = [b"\0", b"\xff", b"\x1b[31m", "\u202e".encode(), b"\n", b"\r", b'"', b"'", b"{", b"[", b"}", b"]", b"<", b">", b"&",
        b",", b":", b"\\", b"\xc3", b"\xed\xa0\x80", b"%s%n", b"../", b"#", b" " * 1000, b"A" * 5000]
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*|-?[0-9][0-9.eE+-]*")


def mutated(data: bytes, others: list[bytes], numbers: random.Random) -> bytes:
    """A file like `data`, with one to eight changes."""
    changed = bytearray(data)
    for _ in range(numbers.choice((1, 1, 1, 2, 3, 8))):
        change(changed, others, numbers)
    return bytes(changed)


def change(data: bytearray, others: list[bytes], numbers: random.Random) -> None:
    """One change, in place."""
    at = numbers.randrange(len(data) + 1)
    end = min(len(data), at + int(2 ** numbers.uniform(0, 12)))
    how = numbers.randrange(13)
    if how == 0 and at < len(data):
        data[at] ^= 1 << numbers.randrange(8)
    elif how == 1 and at < len(data):
        data[at] = numbers.choice((numbers.randrange(256), 0, 0xFF, 0x1B, 0x0A, 0x80, 0x22))
    elif how == 2:
        del data[at:end]
    elif how == 3:
        data[at:at] = data[at:end] * numbers.choice((1, 2, 100))
    elif how == 4:
        del data[at:]
    elif how == 5:
        data[at:at] = numbers.choice(BITS)
    elif how in (6, 7, 8):
        replace_word(data, numbers)
    elif how == 9:
        value = numbers.choice(BINARY)
        size = numbers.choice((2, 4, 8))
        data[at:at + size] = (value & (256 ** size - 1)).to_bytes(size, numbers.choice(("little", "big")))
    elif how == 10:
        other = numbers.choice(others)
        begin = numbers.randrange(len(other) + 1)
        data[at:end] = other[begin:begin + int(2 ** numbers.uniform(0, 10))]
    elif how == 11:
        piece = bytes(data[at:end])
        del data[at:end]
        place = numbers.randrange(len(data) + 1)
        data[place:place] = piece
    elif at < len(data):
        data[at:end] = bytes([numbers.randrange(256)]) * (end - at)


def replace_word(data: bytearray, numbers: random.Random) -> None:
    """A number by one that is at a limit, or a word by another one of the file."""
    begin = numbers.randrange(len(data) + 1)
    words = list(WORD.finditer(bytes(data[begin:begin + 4000])))
    if not words:
        return
    word = numbers.choice(words)
    is_number = word[0][:1] in b"-0123456789"
    new = numbers.choice(NUMBERS) if is_number or numbers.random() < 0.2 else numbers.choice(words)[0]
    data[begin + word.start():begin + word.end()] = new
