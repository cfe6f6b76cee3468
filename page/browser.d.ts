// What the pages know of browsers and TypeScript does not.

interface ParentNode {
  /** The pages look for elements of HTML only. */
  querySelector<Found extends HTMLElement = HTMLElement>(selectors: string): Found | null;
  querySelectorAll<Found extends HTMLElement = HTMLElement>(selectors: string): NodeListOf<Found>;
}

interface Navigator {
  /** In GiB; Chromium only. */
  deviceMemory?: number;
}

interface JSON {
  /** JSON as it is; where a browser has it, parsing tells the source of values, too. */
  rawJSON?(text: string): unknown;
  parse(text: string, reviver: (key: string, value: any, context?: { source?: string }) => any): any;
}

declare var strew: any;
