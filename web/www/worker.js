// The worker: loads the WebAssembly, hands it a canvas, and tells the page what comes of it.

import { detail } from "./detail.js";
import init, { View } from "./raydsl_web.js";

let view = null;
let canvas = null;
// Resolves the rest of a view that has nothing to do.
let wake = () => {};

const tell = (name, value) => postMessage({ name, value });

// What the view calls.
const host = {
  opened: (machine) => tell("opened", machine),
  shown: (samples, milliseconds) => tell("shown", { samples, milliseconds }),
  finished: (light) => tell("finished", { light, shown: pixels() }),
  turn: () => new Promise((resolve) => setTimeout(resolve, 0)),
  rest: () => new Promise((resolve) => { wake = resolve; }),
};

// Returns what a 2-D canvas shows; of any other one nothing can be read.
function pixels() {
  try {
    return canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? null;
  } catch {
    return null;
  }
}

// What the page asks for.
const asked = {
  async open({ query, canvas: given }) {
    canvas = given;
    await init({ module_or_path: new URL("raydsl_web_bg.wasm", import.meta.url) });
    view = new View(query, canvas, host);
    await view.run();
  },
  orbit: ({ aside, aloft }) => view?.orbit(aside, aloft),
  zoom: ({ factor }) => view?.zoom(factor),
};

const fail = (error) => tell("failed", detail(error));

onmessage = async ({ data }) => {
  try {
    const done = asked[data.name](data);
    wake();
    await done;
  } catch (error) {
    fail(error);
  }
};

// A panic ends no promise.
addEventListener("unhandledrejection", ({ reason }) => fail(reason));
