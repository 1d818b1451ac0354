// One WebSocket for everything: requests as JSON, answers as frames of a JSON header, columns of
// 32-bit numbers and cells.

/** Decode a frame: its header, with `column` (name → Float32Array) and `cell` (Uint16Array). */
export function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let offset = 4 + length;
  header.column = {};
  for (const [name, count] of header.columns) {
    header.column[name] = new Float32Array(buffer, offset, count);
    offset += 4 * count;
  }
  header.cell = new Uint16Array(buffer, offset, header.cells);
  return header;
}

/** What is asked of a server that is gone. */
const GONE = { message: "The server is gone.", remedy: "Start `impactid explore` again." };

/** What is larger than the server takes. */
const TOO_LARGE = { kind: "refused", taken: false, message: "This is larger than what the explorer takes.", remedy: "Take fewer steps or lines." };

/** What is answered once, to the newest request alone. */
const REPLACED = new Set(["proposals", "tables"]);

export class Wire {
  /** `receive(frame, since, state)` is called with every frame that answers the newest request of its slot. */
  constructor(token, receive, closed) {
    this.receive = receive;
    this.next = 1;
    this.most = Infinity;  // bytes of a message, as the server says
    this.newest = {};      // slot → id of its newest request
    this.asked = new Map(); // id → { slot, since, state, promise } of what may still be answered
    this.busy = {};        // slot → id that is waited for, of slots that ask one at a time
    this.waiting = {};     // slot → request to be sent then
    this.keyAt = 0;        // time of the last key, ms
    document.addEventListener("keydown", (event) => { this.keyAt = event.timeStamp; }, true);
    const protocols = ["impactid.1", "token." + token];
    this.socket = new WebSocket(`ws://${location.host}/ws`, protocols);
    this.socket.binaryType = "arraybuffer";
    this.opened = new Promise((resolve) => { this.socket.onopen = resolve; });
    this.socket.onmessage = (event) => this.take(decode(event.data));
    this.socket.onclose = () => { for (const { promise } of this.asked.values()) promise?.reject(GONE); closed(); };
  }

  /** Now, or the key that led here. */
  clock() {
    const now = performance.now();
    return now - this.keyAt < 30 ? this.keyAt : now;
  }

  /** Ask for what replaces every earlier request of the slot. */
  ask(slot, ask, state, since) {
    const id = this.next++;
    this.asked.delete(this.newest[slot]);
    this.newest[slot] = id;
    this.asked.set(id, { slot, state, since: since ?? this.clock() });
    const text = JSON.stringify({ id, ask, state });
    if (3 * text.length > this.most && new Blob([text]).size > this.most) queueMicrotask(() => this.take({ ...TOO_LARGE, id }));
    else if (this.socket.readyState === 1) this.socket.send(text);
    return id;
  }

  /** Ask one at a time: while an answer is waited for, only the newest request is kept. `make` gives
   * [ask, state] when it is sent, so that it starts from the answer before. */
  askAfter(slot, make) {
    const since = this.clock();
    if (this.busy[slot]) {
      this.waiting[slot] = [make, this.waiting[slot]?.[1] ?? since];
      return;
    }
    this.busy[slot] = this.ask(slot, ...make(), since);
  }

  /** Ask for what is answered once. */
  once(ask, state) {
    if (this.socket.readyState > 1) return Promise.reject(GONE);
    const slot = REPLACED.has(ask.kind) ? ask.kind : "once" + this.next;
    const id = this.ask(slot, ask, state);
    return new Promise((resolve, reject) => { this.asked.get(id).promise = { resolve, reject }; });
  }

  take(frame) {
    const request = this.asked.get(frame.id), slot = request?.slot, refused = frame.kind === "refused";
    if (request?.promise) {
      this.asked.delete(frame.id);
      if (refused) request.promise.reject(frame); else request.promise.resolve(frame);
      return;
    }
    if (this.busy[slot] === frame.id) this.busy[slot] = 0;
    if (refused || this.newest[slot] === frame.id || frame.id === 0) this.receive(frame, request?.since, request?.state);
    if (!this.busy[slot] && this.waiting[slot]) {
      const [make, asked] = this.waiting[slot];
      delete this.waiting[slot];
      this.busy[slot] = this.ask(slot, ...make(), asked);
    }
  }
}
