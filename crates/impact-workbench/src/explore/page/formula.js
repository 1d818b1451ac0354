// A formula in v as text, without the browser's own evaluation, which the page's policy forbids.

const FUNCTIONS = { exp: Math.exp, log: Math.log, ln: Math.log, sqrt: Math.sqrt, abs: Math.abs, min: Math.min, max: Math.max, tanh: Math.tanh };
const STEPS = [
  { "+": (a, b) => a + b, "-": (a, b) => a - b },
  { "*": (a, b) => a * b, "/": (a, b) => a / b },
];

/** The function of v that a text states; throws where it states none. */
export function formula(text) {
  const tokens = text.replaceAll("−", "-").replaceAll("·", "*").match(/\d*\.?\d+(?:e[-+]?\d+)?|[a-z]+|[-+*/^(),]|\S/gi) ?? [];
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
      while (take(",")) values.push(level(0));
      need(")");
      return (v) => FUNCTIONS[token](...values.map((of) => of(v)));
    }
    if (!Number.isFinite(Number(token))) throw new Error(`“${token ?? "the end"}” is not understood`);
    return () => Number(token);
  };
  const whole = level(0);
  if (at < tokens.length) throw new Error(`“${tokens[at]}” is not understood`);
  return whole;
}

/** Speeds at which a formula becomes a table: closer together where R changes most, up to a speed that no sample reaches. */
const SPEEDS = Array.from({ length: 121 }, (_, i) => Number((30 * (i / 120) ** 2).toPrecision(6)));

/** R(v) of a formula as a table; throws where it is no R. */
export function tableOf(text) {
  const of = formula(text);
  return SPEEDS.map((v) => {
    const r = of(v);
    if (!(r >= 0 && r <= 1)) throw new Error(`R(${v}) = ${Number(r.toPrecision(4))} is not between 0 and 1`);
    return [v, Number(r.toPrecision(9))];
  });
}
