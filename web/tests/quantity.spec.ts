// Numbers with units, and what is none: as parse_length and parse_angle of the library have them.
import { expect, test } from "@playwright/test";
import { quantity, writtenQuantity } from "../src/model/quantity";

test("lengths and angles have units", () => {
  for (const [text, metres] of [
    ["400 ft", 121.92], ["0.1 KM", 100], ["1 mi", 1609.344], ["7.5 cm", 0.075], ["30 mm", 0.03], ["90", 90], ["1e308 ft", 3.048e307],
  ] as const) {
    const read = quantity(text, "length");
    expect(typeof read).toBe("number");
    expect(Math.abs((read as number) / metres - 1)).toBeLessThan(1e-15);
  }
  expect(quantity("60\u00b0", "angle")).toBe(60);
  expect(quantity("60 DEG", "angle")).toBe(60);
});

test("what is no unit is refused with words", () => {
  // Names of what every object of the language has are no units either.
  for (const unit of ["constructor", "toString", "__proto__", "hasOwnProperty", "valueOf", "yd", "M", "Mm", "nm", "deg"]) {
    expect(quantity(`400 ${unit}`, "length")).toContain(unit);
    expect(writtenQuantity(`400 ${unit}`, "length")).toBeNull();
  }
  expect(quantity("60 constructor", "angle")).toContain("constructor");
  for (const text of ["1e999", "1e308 mi", "1e999 ft"]) expect(typeof quantity(text, "length")).toBe("string");
});
