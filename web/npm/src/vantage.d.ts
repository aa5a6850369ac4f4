/** What Emscripten makes of the engine; the build puts it beside. */
export interface EngineModule {
  FS: {
    writeFile(name: string, bytes: Uint8Array): void;
    readFile(name: string): Uint8Array;
    mkdirTree(name: string): void;
    readdir(name: string): string[];
    stat(name: string): { mode: number };
    isDir(mode: number): boolean;
    unlink(name: string): void;
    rmdir(name: string): void;
  };
  HEAPU8: Uint8Array;
  onProgress?: (stage: string, fraction: number) => number;
  UTF8ToString(at: number): string;
  _malloc(size: number): number;
  _free(at: number): void;
  _vantage_python_call(at: number): number;
}
export default function createVantage(options: { wasmBinary: ArrayBuffer | Uint8Array }): Promise<EngineModule>;
