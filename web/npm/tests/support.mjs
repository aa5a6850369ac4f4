import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../..", import.meta.url));
export const program = process.env.VANTAGE ?? join(root, "build/bin/vantage");
export const shared = process.env.VANTAGE_SHARED ?? resolve(root, "../shared");
export const plaza = join(root, "examples/plaza/plaza.obj");

/** The PLY file that the program makes of a mission with that mesh. */
export function byProgram(mission, mesh) {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  try {
    const name = mesh.split("/").at(-1);
    writeFileSync(join(folder, name), readFileSync(mesh));
    writeFileSync(join(folder, "mission.yaml"), mission);
    execFileSync(program, ["compute", join(folder, "mission.yaml"), "-o", join(folder, "volume.ply"), "-q"]);
    return readFileSync(join(folder, "volume.ply"));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

export const noProgram = existsSync(program) ? false : `no program at ${program}: set VANTAGE`;
