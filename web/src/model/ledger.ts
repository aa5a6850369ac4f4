// What the scene's source says stands there and the scene has not as it stands, in words.
import type { Ledger, LedgerEntry } from "../engine/messages";

export function ledgerText({ count, held }: Ledger): string {
  const open = count - held;
  const rest = open > 0 ? `; nothing holds that of ${open}: volumes may claim too much behind` : "";
  return `Not built as the source has it: ${count}. Blockers hold the place of ${held}${rest}.`;
}

/** "way/7 Old mill: its ring is open; instead: its outline, 12 m high". */
export function ledgerLine({ name, what, reason, instead, held, may_be_larger }: LedgerEntry): string {
  const kind = what === "" || what === name ? "" : ` (${what})`;
  const holds = held ? `; instead: ${instead}${may_be_larger ? ", and it may be larger" : ""}` : "; nothing holds its place";
  return `${name}${kind}: ${reason}${holds}`;
}
