// Numbers with units, as the program reads them (parse_length and parse_angle of vantage/input.h).

export type QuantityKind = "length" | "angle";

type Units = ReadonlyMap<string, [times: number, over: number]>; // no object, which has a "constructor", too

const LENGTHS: Units = new Map([
  ["m", [1, 1]], ["km", [1000, 1]], ["ft", [3048, 10000]], ["mi", [1609344, 1000]], ["cm", [1, 100]], ["mm", [1, 1000]],
]);
const ANGLES: Units = new Map([["deg", [1, 1]], ["\u00b0", [1, 1]]]);

const FORMS: Record<QuantityKind, string> = {
  length: "write metres, or a number with mm, cm, m, km, ft or mi: 120, 120 m, 400 ft",
  angle: "write degrees, with or without their unit: 60, 60\u00b0",
};

/**
 * Metres or degrees that were typed; a text says why they are not understood. A comma is a decimal one, but not before
 * three digits: "1,000 ft" is a thousand to some.
 */
export function quantity(text: string, kind: QuantityKind): number | string {
  const found = /^\s*([-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[-+]?\d+)?)\s*(.*?)\s*$/i.exec(text);
  if (!found) return FORMS[kind];
  const [, digits, unit] = found as unknown as [string, string, string];
  if (/^[-+]?[1-9]\d*,\d{3}$/.test(digits)) return `write ${digits.replace(",", "")} or ${digits.replace(",", ".")}: a comma may mean either`;
  const value = Number(digits.replace(",", "."));
  if (!Number.isFinite(value)) return `${digits} is more than a number holds`;
  if (unit === "") return value;
  // "M" stands for nautical miles, too, and "Mm" for a million metres.
  const known = unit === "M" || unit === "Mm" ? undefined : (kind === "length" ? LENGTHS : ANGLES).get(unit.toLowerCase());
  if (!known) return `"${unit}" is no unit here: ${FORMS[kind]}`;
  const converted = times(value, known);
  return Number.isFinite(converted) ? converted : `${text.trim()} is more than a number holds`;
}

/** Rounded once; twice where the product alone is more than a number holds. */
function times(value: number, [factor, over]: [number, number]): number {
  const product = value * factor;
  return Number.isFinite(product) ? product / over : (value / over) * factor;
}

/** What a mission file has: a number, or a text with its unit. null: something else. */
export function writtenQuantity(value: unknown, kind: QuantityKind): number | null {
  if (typeof value === "number") return value;
  if (typeof value !== "string" || value.includes(",")) return null;
  const read = quantity(value, kind);
  return typeof read === "number" ? read : null;
}

/** With the digits that count: 12.3 m, 0.0123 m. */
export function metres(value: number): string {
  const digits = Math.abs(value) >= 10 ? Math.round(value * 10) / 10 : Number(value.toPrecision(3));
  return `${digits} m`;
}

/** With groups of three digits, and parts where they count: 1,234,567; 12.34; 0.0123. */
export function large(value: number): string {
  if (value > 0 && value < 0.1) return String(Number(value.toPrecision(3)));
  return value.toLocaleString("en", { maximumFractionDigits: value < 100 ? 2 : 0 });
}
