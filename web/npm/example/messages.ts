export interface Job {
  mission: string;
  files: Record<string, Uint8Array>;
}

export type News =
  | { stage: string; fraction: number }
  | { volumeM3: number; facets: number; causes: string[]; ply: Uint8Array }
  | { error: string };
