// The engine works here, so that the page stays awake.
import { compute } from "vantage-engine";
import type { Job, News } from "./messages";

const tell = (news: News) => postMessage(news);

onmessage = async ({ data }: MessageEvent<Job>) => {
  try {
    const volume = await compute(data.mission, data.files, { onProgress: (stage, fraction) => tell({ stage, fraction }) });
    tell({
      volumeM3: volume.report.volume_m3 as number, facets: volume.faces.length / 3, causes: volume.causes.map(({ name }) => name),
      ply: volume.save("ply"),
    });
    volume.release();
  } catch (error) {
    tell({ error: String(error) });
  }
};
