// The elements of the page, by id.

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

export const input = (id: string) => element<HTMLInputElement>(id);
export const button = (id: string) => element<HTMLButtonElement>(id);

export function showMessage(text: string, isBad = false): void {
  const hint = element("hint");
  hint.textContent = text;
  hint.classList.toggle("bad", isBad);
  hint.hidden = text === "";
}

/** Takes back what was said last, if it is one of these. */
export function clearMessage(...texts: string[]): void {
  replaceMessage("", ...texts);
}

/** Says this in the place of what was said last, if that is one of these. */
export function replaceMessage(text: string, ...texts: string[]): void {
  if (texts.includes(element("hint").textContent ?? "")) showMessage(text);
}

/** Whether what was said last is an error. */
export const showsError = () => element("hint").classList.contains("bad");

export function option(value: string, text: string): HTMLOptionElement {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = text;
  return made;
}

/** Of a list of terms. */
export function terms(rows: [string, string][]): HTMLElement[] {
  return rows.flatMap(([term, value]) => {
    const dt = document.createElement("dt");
    const dd = document.createElement("dd");
    dt.textContent = term;
    dd.textContent = value;
    return [dt, dd];
  });
}

/** A colour, for a style. */
export const hex = (colour: number) => `#${colour.toString(16).padStart(6, "0")}`;
