// What the engine asks of its host: in JavaScript the function that the caller gave (web/npm/src/engine.ts); Python
// brings its own (python/wasm/vantage/_core/_engine.py).
mergeInto(LibraryManager.library, {
  vantage_host_progress: function (stage, length, fraction) {
    return Module["onProgress"] ? Module["onProgress"](UTF8ToString(stage, length), fraction) : 0;
  },
});
