import type { Job, News } from "./messages";

const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
const input = document.querySelector("input")!, bar = document.querySelector("progress")!, text = document.querySelector("pre")!;

input.onchange = async () => {
  const job: Job = { mission: "", files: {} };
  for (const file of input.files ?? []) {
    if (/\.ya?ml$/.test(file.name)) job.mission = await file.text();
    else job.files[file.name] = new Uint8Array(await file.arrayBuffer());
  }
  worker.postMessage(job);
};

worker.onmessage = async ({ data }: MessageEvent<News>) => {
  if ("fraction" in data) bar.value = data.fraction;
  else if ("error" in data) text.textContent = data.error;
  else {
    const hash = await crypto.subtle.digest("SHA-256", data.ply);
    const digits = [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, "0")).join("");
    text.textContent = JSON.stringify({ volume_m3: data.volumeM3, facets: data.facets, causes: data.causes, ply_sha256: digits }, null, 2);
  }
};
