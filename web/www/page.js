// The page: what is asked for, what a person does, and what the worker tells. A worker renders, so
// that the page answers meanwhile; another choice is another worker.

import { detail } from "./detail.js";

const query = new URLSearchParams(location.search);
const choices = document.getElementById("choices");
const place = document.getElementById("picture");
const status = document.getElementById("status");
const error = document.getElementById("error");

let worker = null;
let machine = "";
let isReported = false;

for (const select of choices.elements) {
  const asked = query.get(select.name);
  if (asked !== null) {
    select.value = asked;
  }
  select.addEventListener("change", () => {
    query.set(select.name, select.value);
    // Another scene counts something else by it, and would refuse the number.
    if (select.name === "scene") {
      query.delete("detail");
    }
    // Only WGSL is submitted; another variant would be refused.
    if (choices.elements.variant.value !== "wgsl") {
      query.delete("submit");
    }
    history.replaceState(null, "", `?${query}`);
    open();
  });
}

function open() {
  if (worker !== null) {
    // What it has told already would be taken for the next one's.
    worker.onmessage = worker.onmessageerror = worker.onerror = null;
    worker.terminate();
  }
  error.hidden = true;
  status.textContent = "Loading";
  const canvas = document.createElement("canvas");
  place.replaceChildren(canvas);
  listen(canvas);
  worker = new Worker("worker.js", { type: "module" });
  worker.onmessage = ({ data: { name, value } }) => heard[name](value);
  worker.onmessageerror = () => heard.failed("what the worker tells cannot be read");
  worker.onerror = (event) => {
    event.preventDefault();
    heard.failed(event.message || "the worker cannot be loaded");
  };
  if (!canvas.transferControlToOffscreen) {
    heard.failed("this browser has no OffscreenCanvas: open the page in a newer one");
    return;
  }
  const offscreen = canvas.transferControlToOffscreen();
  worker.postMessage({ name: "open", query: `?${query}`, canvas: offscreen }, [offscreen]);
}

// What a worker tells.
const heard = {
  opened(name) {
    machine = name;
    status.textContent = `${machine}: making the first picture`;
  },
  shown({ samples, milliseconds }) {
    const state = samples === 0 ? "moving" : `${samples} samples`;
    status.textContent = `${machine}: ${state}, ${milliseconds.toFixed(0)} ms`;
  },
  finished(picture) {
    report(picture);
  },
  failed(thrown) {
    error.textContent = detail(thrown);
    error.hidden = false;
    status.textContent = "Failed";
    report({});
  },
};

function listen(canvas) {
  let last = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    last = event;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (last === null || event.buttons === 0) {
      return;
    }
    const [aside, aloft] = [event.clientX - last.clientX, event.clientY - last.clientY];
    last = event;
    worker.postMessage({ name: "orbit", aside: -0.4 * aside, aloft: 0.4 * aloft });
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    worker.postMessage({ name: "zoom", factor: Math.exp(0.001 * event.deltaY) });
  }, { passive: false });
}

// Tells a test, which opens the page with `report=ID`, what the page shows first: a line of JSON, the
// light, and the bytes of the canvas.
async function report({ light, shown }) {
  if (!query.has("report") || isReported) {
    return;
  }
  isReported = true;
  light ??= new Float32Array();
  const head = JSON.stringify({
    status: status.textContent,
    error: error.checkVisibility() ? error.textContent : "",
    light: light.byteLength,
  });
  const body = new Blob([head, "\n", light, shown ?? ""]);
  await fetch(`/report/${encodeURIComponent(query.get("report"))}`, { method: "POST", body });
}

// What fails here is shown as well.
addEventListener("error", (event) => heard.failed(event.error ?? event.message));
addEventListener("unhandledrejection", ({ reason }) => heard.failed(reason));

open();
