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


declare var strew: any;
