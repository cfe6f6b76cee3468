// Makes chunks off the page's thread, and hands their memory over without a copy.
import { open } from "../lib/index.js";

const strew = open();

addEventListener("message", async ({ data: { set, size, x, y } }) => {
    try {
        const { xy, origin } = (await strew).points(set).chunk(size, x, y).xyF32();
        postMessage({ x, y, origin, xy }, [xy.buffer]);
    } catch (error) {
        postMessage({ x, y, error: error.message });
    }
});
