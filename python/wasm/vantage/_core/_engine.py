"""The engine in WebAssembly: one for the process, made by the first call. python/wasm/src/exports.cpp is the other side."""

from __future__ import annotations

import collections
import json
import os
import pathlib
import threading
import time
import weakref
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import wasmtime

from .._errors import Error, NotInBuildError, make
from .._progress import Progress, listener
from ._cache import compiled
from ._system import System

_FILE = pathlib.Path(__file__).parent / "engine.wasm"
_PAGE = 65536
_TYPES: dict[str, np.dtype[Any]] = {"f8": np.dtype("<f8"), "u4": np.dtype("<u4"), "u1": np.dtype("u1")}


def error_of(told: Mapping[str, Any]) -> Error:
    """The error that the engine tells of."""
    if told["code"] in ("component-missing", "library-missing"):
        return NotInBuildError("input", told["code"], told["problem"], told["where"],
                               "this build of vantage runs in WebAssembly; the native package for Linux x86-64 has it", told["object"])
    return make(told["kind"], told["code"], told["problem"], told["where"], told["fix"], told["object"])


class _Watch:
    """Of one call: tells the caller's function, and remembers what it raised."""

    def __init__(self, progress: Progress) -> None:
        self._told = listener(progress)
        self._last = time.monotonic()
        self._skipped = 0
        self.raised: BaseException | None = None

    def __call__(self, stage: str, fraction: float) -> int:
        """How many calls need not be told; below 0: stop. Also here signals are heard, such as Ctrl-C."""
        try:
            if self._told is not None and self._told(stage, fraction) is False:
                return -1
            now = time.monotonic()
            since, self._last = now - self._last, now
            if since < 0.02:
                self._skipped = min(2 * self._skipped + 1, 1 << 14)
            elif since > 0.1:
                self._skipped //= 4
            return self._skipped
        except BaseException as error:  # it must not fly through the engine
            self.raised = error
            return -1


class Engine:
    """An instance with its memory. One call at a time; other threads wait."""

    def __init__(self) -> None:
        config = wasmtime.Config()
        config.wasm_exceptions = True
        config.wasm_function_references = True
        config.wasm_gc = True
        engine = wasmtime.Engine(config)
        module = compiled(engine, _FILE.read_bytes())
        self._store = wasmtime.Store(engine)
        self._lock = threading.Lock()
        self._owner = 0
        self._watch = _Watch(None)
        self._garbage: collections.deque[tuple[str, int]] = collections.deque()
        self._broken = ""
        linker = wasmtime.Linker(engine)
        known = {**System(self).functions(), "vantage_host_progress": self._progress}
        for one in module.imports:
            name = one.name or ""
            work = known.get(name) or _not_there(name)
            linker.define_func(one.module, name, one.type, work)
        exports = linker.instantiate(self._store, module).exports(self._store)
        self._exports: dict[str, Any] = {name: exports[name] for name in
                                         ("memory", "malloc", "free", "vantage_python_call", "__wasm_call_ctors")}
        self._exports["__wasm_call_ctors"](self._store)

    # ---- its memory

    def read(self, at: int, size: int) -> bytearray:
        return bytearray(self._exports["memory"].read(self._store, at & 0xFFFFFFFF, (at & 0xFFFFFFFF) + size))

    def write(self, at: int, data: bytes) -> None:
        if data:
            self._exports["memory"].write(self._store, data, at & 0xFFFFFFFF)

    def grow_to(self, size: int) -> bool:
        memory = self._exports["memory"]
        now = memory.data_len(self._store)
        for wanted in (max(size, now + min(now // 5, 96 << 20)), size):  # a fifth more, so that it grows rarely
            try:
                memory.grow(self._store, -(-(wanted - now) // _PAGE))
                return True
            except wasmtime.WasmtimeError:
                continue
        return False

    def array(self, told: Mapping[str, int], kind: str, columns: int = 0) -> npt.NDArray[Any]:
        """A read-only copy of an array; with `columns`, rows of so many numbers."""
        of = _TYPES[kind]
        with self._lock_once():
            made = np.frombuffer(bytes(self.read(told["at"], told["count"] * of.itemsize)), of)
        return made.reshape(-1, columns) if columns else made

    def _put(self, data: bytes) -> int:
        at = self._exports["malloc"](self._store, max(len(data), 1)) & 0xFFFFFFFF
        if at == 0:
            raise make("input", "out-of-memory", "there is not enough memory for this", "", "use a smaller scene or range", None)
        self.write(at, data)
        return at

    # ---- calls

    def _lock_once(self) -> threading.Lock:
        if self._owner == threading.get_ident():
            raise NotInBuildError("input", "component-missing",
                                  "this build of vantage runs in WebAssembly, and a function of progress cannot call it", "progress",
                                  "call it when the work has ended; in the native package for Linux x86-64 it can")
        return self._lock

    def call(self, name: str, progress: Progress = None, /, **arguments: Any) -> Any:
        """What the engine answers. Arrays in the arguments are copied into its memory, for this call."""
        watch = _Watch(progress)
        with self._lock_once():
            self._owner = threading.get_ident()
            self._watch = watch
            try:
                self._drop_garbage()
                answer = self._call(name, arguments)
            finally:
                self._owner = 0
        if watch.raised is not None:
            raise watch.raised
        if "error" in answer:
            raise error_of(answer["error"])
        return answer["value"]

    def _call(self, name: str, arguments: Mapping[str, Any]) -> dict[str, Any]:
        if self._broken:
            raise make("internal", "internal-defect", f"the engine has stopped before: {self._broken}", "",
                       "make the scene anew: new objects get a new engine", None)
        places: list[int] = []
        try:
            request = json.dumps({"call": name, "arguments": self._passed(arguments, places)})
            places.append(self._put(os.fsencode(request) + b"\0"))
            at = self._run(places[-1])
            answer: dict[str, Any] = json.loads(self._text(at).decode(errors="surrogateescape"))
            answer["value"] = self._copied(answer.get("value"))
            return answer
        finally:
            if not self._broken:
                for place in places:
                    self._exports["free"](self._store, place)

    def _run(self, request: int) -> int:
        """Whatever flies through the engine leaves it in the midst of its work: it is used no more."""
        try:
            return int(self._exports["vantage_python_call"](self._store, request))
        except BaseException as error:
            self._broken = str(error).splitlines()[0] if str(error) else type(error).__name__
            _forget(self)
            if not isinstance(error, Exception):
                raise
            raise make("internal", "internal-defect", f"the engine has stopped: {self._broken}", "",
                       "a scene that is smaller may fit; else please report this", None) from None

    def remember(self, error: BaseException) -> None:
        """What this call is to raise when the engine has come back."""
        self._watch.raised = error

    def _text(self, at: int) -> bytes:
        found, at = b"", at & 0xFFFFFFFF
        size = self._exports["memory"].data_len(self._store)
        while b"\0" not in found:
            step = min(max(4096, len(found)), size - at - len(found))
            found += bytes(self.read(at + len(found), step))
        return found[:found.index(b"\0")]

    def _passed(self, value: Any, places: list[int]) -> Any:
        if isinstance(value, np.ndarray):
            places.append(self._put(value.tobytes()))
            return {"at": places[-1], "count": int(value.size)}
        if isinstance(value, Held):
            return value.number_in(self)
        if isinstance(value, Mapping):
            return {key: self._passed(item, places) for key, item in value.items()}
        if isinstance(value, (list, tuple)):
            return [self._passed(item, places) for item in value]
        return value

    def _copied(self, value: Any) -> Any:
        """With the arrays that stay only until the next call; those of objects state no kind, and are copied when asked for."""
        if isinstance(value, dict) and value.keys() == {"at", "count", "kind"}:
            of = _TYPES[value["kind"]]
            return np.frombuffer(bytes(self.read(value["at"], value["count"] * of.itemsize)), of)
        if isinstance(value, dict):
            return {key: self._copied(item) for key, item in value.items()}
        if isinstance(value, list) and value and isinstance(value[0], dict):
            return [self._copied(item) for item in value]
        return value

    def _progress(self, stage: int, length: int, fraction: float) -> int:
        return self._watch(bytes(self.read(stage, length)).decode(errors="replace"), fraction)

    # ---- objects that Python no longer needs

    def release(self, kind: str, number: int) -> None:
        """To be freed by the next call: Python may notice in the midst of one."""
        self._garbage.append((kind, number))

    def _drop_garbage(self) -> None:
        while self._garbage and not self._broken:
            kind, number = self._garbage.popleft()
            self._call(f"free_{kind}", {"object": number})


class Held:
    """An object of the engine, by its number."""

    kind = ""

    def __init__(self, engine: Engine, number: int) -> None:
        self.engine = engine
        self._number = number
        weakref.finalize(self, engine.release, self.kind, number).atexit = False

    def number_in(self, engine: Engine) -> int:
        """Objects of an engine that has stopped are lost."""
        if engine is not self.engine:
            raise make("internal", "internal-defect", "this object was lost when the engine stopped", "", "make it anew", None)
        return self._number

    def _call(self, name: str, progress: Progress = None, /, **arguments: Any) -> Any:
        return self.engine.call(name, progress, **arguments)


def _not_there(name: str) -> Callable[..., Any]:
    def call(*_: Any) -> Any:
        raise RuntimeError(f"it called {name}, which it should not need")

    return call


_one: Engine | None = None
_making = threading.Lock()


def engine() -> Engine:
    """The engine of this process."""
    global _one
    with _making:
        if _one is None:
            _one = Engine()
        return _one


def _forget(broken: Engine) -> None:
    global _one
    if _one is broken:
        _one = None
