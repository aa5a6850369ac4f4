// Answers of the program, in the order in which they come.
import { expect, test } from "@playwright/test";
import { Pending } from "../src/engine/transport";

test("that a request waits for a turn is told, and is not its answer", async () => {
  const pending = new Pending();
  const told: boolean[] = [];
  pending.onWaits = (waits) => told.push(waits);
  const { id, answer } = pending.add();
  pending.take({ id, waits: true, engine_ms: 0 });
  pending.take({ id, waits: false, engine_ms: 0 });
  expect(told).toEqual([true, false]);
  pending.take({ id, value: 7, engine_ms: 1 });
  expect((await answer).value).toBe(7);
});
