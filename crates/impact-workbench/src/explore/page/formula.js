// A formula in v as text, without the browser's own evaluation, which the page's policy forbids.

/** Of each function: it, and of how many values at most. */
const FUNCTIONS = { exp: [Math.exp, 1], log: [Math.log, 1], ln: [Math.log, 1], sqrt: [Math.sqrt, 1], abs: [Math.abs, 1], tanh: [Math.tanh, 1], min: [Math.min, Infinity], max: [Math.max, Infinity] };
/** A number with a point or, where no second one follows, a decimal comma. */
const NUMBER = /(?:\d+,\d+(?![\d.])|\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?/;
const TOKENS = new RegExp(`${NUMBER.source}|[a-z]+|[-+*/^(),;]|\\S`, "g");
const STEPS = [
  { "+": (a, b) => a + b, "-": (a, b) => a - b },
  { "*": (a, b) => a * b, "/": (a, b) => a / b },
];

/** The function of v that a text states; throws where it states none. */
export function formula(text) {
  const plain = text.toLowerCase().replaceAll("−", "-").replaceAll("·", "*");
  const tokens = plain.replace(/(\d|\))\s*(?=v|\()/g, "$1*").match(TOKENS) ?? [];
  let at = 0;
  const take = (token) => tokens[at] === token && ++at > 0;
  const need = (token) => { if (!take(token)) throw new Error(`“${token}” is missing before “${tokens[at] ?? "the end"}”`); };
  const level = (n) => {
    if (n === STEPS.length) return signed();
    let left = level(n + 1);
    while (tokens[at] in STEPS[n]) {
      const step = STEPS[n][tokens[at++]], [a, b] = [left, level(n + 1)];
      left = (v) => step(a(v), b(v));
    }
    return left;
  };
  const signed = () => {
    if (take("-")) { const of = signed(); return (v) => -of(v); }
    const base = atom();
    if (!take("^")) return base;
    const power = signed();
    return (v) => base(v) ** power(v);
  };
  const atom = () => {
    const token = tokens[at++];
    if (token === "(") { const inside = level(0); need(")"); return inside; }
    if (token === "v") return (v) => v;
    if (token !== undefined && Object.hasOwn(FUNCTIONS, token)) {
      need("(");
      const values = [level(0)];
      while (take(",") || take(";")) values.push(level(0));
      need(")");
      const [of, most] = FUNCTIONS[token];
      if (most === 1 ? values.length > 1 : values.length < 2) throw new Error(`${token} takes ${most === 1 ? "one value" : "two values or more, with “;” between them"}, not ${values.length}`);
      return (v) => of(...values.map((value) => value(v)));
    }
    const number = Number(token?.replace(",", "."));
    if (!Number.isFinite(number)) throw new Error(`“${token ?? "the end"}” is not understood`);
    return () => number;
  };
  const whole = level(0);
  if (at < tokens.length) throw new Error(`“${tokens[at]}” is not understood`);
  return whole;
}

/** Speeds at which a formula becomes a table: closer together where R changes most, up to a speed that no sample reaches. */
const SPEEDS = Array.from({ length: 121 }, (_, i) => Number((30 * (i / 120) ** 2).toPrecision(6)));

/** Formulas by the tables that were made of them. */
const made = new Map();

/** The formula that a law's table was made of here. */
export const formulaOf = (law) => made.get(JSON.stringify(law.table));

/** R(v) of a formula as a table; throws where it is no R. */
export function tableOf(written) {
  const text = written.replace(/^\s*R\s*(\(\s*v\s*\))?\s*=/i, "").trim(), of = formula(text);
  const table = SPEEDS.map((v) => {
    const r = of(v);
    if (!(r >= 0 && r <= 1)) throw new Error(`R(${v}) = ${Number(r.toPrecision(4))} is not between 0 and 1`);
    return [v, Number(r.toPrecision(9))];
  });
  made.set(JSON.stringify(table), text);
  return table;
}
