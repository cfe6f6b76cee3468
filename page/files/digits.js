// JSON whose numbers keep all of their digits.

/** A number that is written as it was typed. */
export class Digits {
  constructor(text) {
    const isNumber = /^-?\d+(\.\d+)?(e[+-]?\d+)?$/i.test(text);
    this.text = isNumber ? text.replace(/^(-?)0+(?=\d)/, "$1") : JSON.stringify(text);
  }
}

/** Writes JSON, with `Digits` as they are; `indent` as of `JSON.stringify`. */
export function json(value, indent = 0) {
  const marks = [];
  const text = JSON.stringify(value, (_, member) => {
    if (!(member instanceof Digits)) return member;
    marks.push(member.text);
    return `\u0000${marks.length - 1}\u0000`;
  }, indent);
  return text.replace(/"\\u0000(\d+)\\u0000"/g, (_, i) => marks[Number(i)]);
}
