// What the engine asks of Python (python/wasm/vantage/_core/_engine.py), by name only: the link needs to know it.
mergeInto(LibraryManager.library, {
  vantage_host_progress: function (stage, length, fraction) { return 0; },
});
