// A stick under a thumb: how far it is pushed from its middle. Pressing a part of it does what dragging there does, and
// each stick follows its own finger.

/** Pushes below this share of the radius are none, so that a resting thumb does nothing. */
const REST = 0.12;
/** How far the knob moves, in hundredths of its own size. */
const TRAVEL = 62;

/** Calls `pushed([right, up])`, each from −1 to 1, while a pointer is on an element; [0, 0] when it leaves. */
export function stick(element, pushed) {
  const knob = element.querySelector("i");
  let finger = null;
  const set = (x, y) => {
    knob.style.translate = `${x * TRAVEL}% ${-y * TRAVEL}%`;
    const long = Math.hypot(x, y);
    // A gentle push is slow: speed grows with the square.
    const speed = long < REST ? 0 : ((long - REST) / (1 - REST)) ** 2 / long;
    pushed([x * speed, y * speed]);
  };
  const follow = ({ clientX, clientY }) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const [x, y] = [(2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height];
    const far = Math.max(1, Math.hypot(x, y));
    set(x / far, y / far);
  };
  element.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    if (finger !== null) return;
    finger = event.pointerId;
    element.setPointerCapture(finger);
    element.dataset.held = "";
    follow(event);
  });
  element.addEventListener("pointermove", (event) => event.pointerId === finger && follow(event));
  const free = (event) => {
    if (event.pointerId !== finger) return;
    finger = null;
    delete element.dataset.held;
    set(0, 0);
  };
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) element.addEventListener(name, free);
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}
