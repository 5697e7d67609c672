// The page: what is asked for, what a person does, and what the worker tells. A worker renders, so
// that the page answers meanwhile; another choice is another worker.

const query = new URLSearchParams(location.search);
const choices = document.getElementById("choices");
const place = document.getElementById("picture");
const status = document.getElementById("status");
const error = document.getElementById("error");

let worker = null;
let machine = "";

for (const select of choices.elements) {
  const asked = query.get(select.name);
  if (asked !== null) {
    select.value = asked;
  }
  select.addEventListener("change", () => {
    query.set(select.name, select.value);
    history.replaceState(null, "", `?${query}`);
    open();
  });
}

function open() {
  worker?.terminate();
  error.hidden = true;
  status.textContent = "Loading";
  const canvas = document.createElement("canvas");
  place.replaceChildren(canvas);
  listen(canvas);
  worker = new Worker("worker.js", { type: "module" });
  worker.onmessage = ({ data: { name, value } }) => heard[name](value);
  worker.onerror = (event) => heard.failed(event.message || "the worker cannot be loaded");
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
  failed(message) {
    error.textContent = message;
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

// Tells a test, which opens the page with `report`, what the page shows.
async function report({ light, shown }) {
  if (!query.has("report")) {
    return;
  }
  const parts = {
    light: light ?? new Float32Array(),
    shown: shown ?? new Uint8ClampedArray(),
    status: status.textContent,
    error: error.checkVisibility() ? error.textContent : "",
    end: "",
  };
  for (const [name, body] of Object.entries(parts)) {
    await fetch(`report/${name}`, { method: "POST", body });
  }
}

open();
