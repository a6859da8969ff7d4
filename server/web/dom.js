// SPDX-License-Identifier: BSD-3-Clause
/** Helpers to create elements. Texts are always set as text, never as HTML. */

/** @typedef {Node | string | false | null | undefined} Child */

/**
 * An element: attributes by their names, `on_NAME` for listeners, `class`, and true for an attribute without value.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag @param {Record<string, any>} [attributes] @param {...Child} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  set_attributes(made, attributes);
  made.append(...children.filter((c) => c !== false && c !== null && c !== undefined));
  return made;
}

/**
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} tag @param {Record<string, any>} [attributes] @param {...Child} children
 * @returns {SVGElementTagNameMap[K]}
 */
export function svg(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set_attributes(made, attributes);
  made.append(...children.filter((c) => c !== false && c !== null && c !== undefined));
  return made;
}

/** @param {Element} made @param {Record<string, any>} attributes */
function set_attributes(made, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on_")) made.addEventListener(name.slice(3), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined && value !== null) made.setAttribute(name, String(value));
  }
}

/** The element of the page with this id. @param {string} id @returns {HTMLElement} */
export function by_id(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page has no ${id}.`);
  return found;
}

let fields = 0;

/**
 * A labelled row: the label's text, and a control that the label names.
 * @param {string} text @param {HTMLElement} control @param {...Child} more
 */
export function row(text, control, ...more) {
  control.id ||= `control-${++fields}`;
  return element("div", { class: "row" }, element("label", { for: control.id }, text), control, ...more);
}

/** A checkbox with its label. @param {string} text @param {(checked: boolean) => void} change @param {string} [title] */
export function checkbox(text, change, title) {
  const input = element("input", { type: "checkbox", on_change: () => change(input.checked) });
  return { input, label: element("label", { class: "check", title }, input, element("span", {}, text)) };
}

/**
 * @param {string} label @param {(value: string) => void} change @param {(string | [string, string])[]} options values, or values and texts
 */
export function choice(label, change, options = []) {
  const select = element("select", { "aria-label": label || undefined, on_change: () => change(select.value) });
  fill_choice(select, options);
  return select;
}

/** @param {HTMLSelectElement} select @param {(string | [string, string])[]} options */
export function fill_choice(select, options) {
  const value = select.value;
  select.replaceChildren(...options.map((option) => {
    const [word, text] = typeof option === "string" ? [option, option] : option;
    return element("option", { value: word }, text);
  }));
  if (value) select.value = value;
}

/**
 * A text field whose value is used on Enter or when it loses the focus; `change` returns false for an invalid value,
 * which the event "untaken" reports.
 * @param {string} label @param {(text: string) => boolean | void} change @param {Record<string, any>} [attributes]
 */
export function typed(label, change, attributes = {}) {
  const input = element("input", {
    type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", "aria-label": label || undefined, ...attributes,
    on_change: () => {
      const taken = change(input.value) !== false;
      input.setAttribute("aria-invalid", String(!taken));
      if (taken) {
        input.dataset.held = input.value;
        return;
      }
      const named = label || (input.labels?.[0]?.textContent ?? "");
      input.dispatchEvent(new CustomEvent("untaken", { bubbles: true, detail: { label: named, text: input.value, held: input.dataset.held } }));
    },
    on_focus: () => { input.dataset.held = input.value; },
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") input.dispatchEvent(new Event("change"));
  });
  return input;
}

/** Whether the control contains text that has not been used yet. @param {HTMLInputElement} input */
export const being_typed = (input) => document.activeElement === input && input.type === "text" && input.value !== input.dataset.held;

/** Sets a control's value, unless the user is typing in it. @param {HTMLInputElement} input @param {string} value */
export function show_value(input, value) {
  if (being_typed(input)) return;
  input.value = value;
  if (input.type === "text") input.dataset.held = value;
  input.removeAttribute("aria-invalid");
}

/** @param {string} text @param {() => void} click @param {Record<string, any>} [attributes] */
export const button = (text, click, attributes = {}) => element("button", { type: "button", on_click: click, ...attributes }, text);

/** @param {string} name of a symbol in the page @param {string} label @param {() => void} click @param {Record<string, any>} [attributes] */
export const icon_button = (name, label, click, attributes = {}) =>
  element("button", { type: "button", class: "icon", title: label, "aria-label": label, on_click: click, ...attributes }, icon(name));

/** @param {string} name */
export const icon = (name) => svg("svg", { class: "glyph", "aria-hidden": "true" }, svg("use", { href: `#icon-${name}` }));

/**
 * Returns a function that calls `work` after it has not been called for `delay` milliseconds.
 * @template {any[]} A @param {(...values: A) => void} work @param {number} delay
 */
export function debounced(work, delay) {
  let timer = 0;
  return (/** @type {A} */ ...values) => {
    clearTimeout(timer);
    timer = window.setTimeout(() => work(...values), delay);
  };
}

/** Offers bytes to the user as a file. @param {Blob} blob @param {string} name */
export function save_file(blob, name) {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** A preference stored in this browser, or `otherwise` without one. @param {string} name @param {string} otherwise */
export function preference(name, otherwise) {
  try {
    return localStorage.getItem(`tessera.${name}`) ?? otherwise;
  } catch {
    return otherwise;
  }
}

/** @param {string} name @param {string} value */
export function set_preference(name, value) {
  try {
    localStorage.setItem(`tessera.${name}`, value);
  } catch {
    // Without storage in the browser, the page works, but preferences are not kept.
  }
}
