/** What is wrong, where, and what to do about it. `code` stays the same from version to version: docs/errors.md. */
export class VantageError extends Error {
  /** "input", "output", "cancelled" or "internal" (a defect of vantage) */
  readonly kind: string;
  readonly code: string;
  readonly problem: string;
  /** a file with line and column, an object of the scene; may be empty */
  readonly where: string;
  /** may be empty */
  readonly fix: string;

  constructor(told: { kind: string; code: string; problem: string; where: string; fix: string }) {
    super([told.problem, told.where && `where: ${told.where}`, told.fix && `what to do: ${told.fix}`].filter(Boolean).join("\n  "));
    this.name = "VantageError";
    this.kind = told.kind;
    this.code = told.code;
    this.problem = told.problem;
    this.where = told.where;
    this.fix = told.fix;
  }
}

export function inputError(code: string, problem: string, where: string, fix: string): VantageError {
  return new VantageError({ kind: "input", code, problem, where, fix });
}
