// Undo and redo of missions.

export class History<State> {
  private readonly done: string[] = [];
  private undone: string[] = [];

  constructor(state: State) {
    this.done.push(JSON.stringify(state));
  }

  /** To be called when a change is complete: at the end of a drag. */
  keep(state: State): void {
    const text = JSON.stringify(state);
    if (text === this.done[this.done.length - 1]) return;
    this.done.push(text);
    if (this.done.length > 200) this.done.shift();
    this.undone = [];
  }

  undo(): State | null {
    if (this.done.length < 2) return null;
    this.undone.push(this.done.pop()!);
    return JSON.parse(this.done[this.done.length - 1]!) as State;
  }

  redo(): State | null {
    const text = this.undone.pop();
    if (text === undefined) return null;
    this.done.push(text);
    return JSON.parse(text) as State;
  }
}
