/** Elements in one line each. */

type Attributes = Readonly<Record<string, string | number | boolean | ((event: Event) => void)>>;
type Child = Node | string;

/** h('button', {class: 'x', onclick: f}, 'text'): functions become listeners, true an empty attribute, false none. */
export function h<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name.replace(/^on/, ''), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

export function byId(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page lacks #${id}`);
  return element;
}

export function button(text: string, onclick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick, ...attributes }, text);
}

export interface Choice<Word extends string> {
  readonly element: HTMLLabelElement;
  set(word: Word): void;
}

/** A labelled list of choices. */
export function choice<Word extends string>(label: string, words: readonly (readonly [Word, string])[], onchange: (word: Word) => void): Choice<Word> {
  const select = h('select', { 'aria-label': label, onchange: () => onchange(select.value as Word) }, ...words.map(([word, text]) => h('option', { value: word }, text)));
  return { element: h('label', { class: 'row' }, h('span', {}, label), select), set: (word) => void (select.value = word) };
}

export interface Tick {
  readonly element: HTMLLabelElement;
  readonly input: HTMLInputElement;
}

export function tick(label: string, checked: boolean, onchange: (checked: boolean) => void): Tick {
  const input = h('input', { type: 'checkbox', checked, onchange: () => onchange(input.checked) });
  return { element: h('label', { class: 'tick' }, input, h('span', {}, label)), input };
}

export interface Slider {
  readonly element: HTMLLabelElement;
  readonly input: HTMLInputElement;
  set(value: number): void;
}

export interface SliderRange {
  readonly min: number;
  readonly max: number;
  readonly step: number;
  readonly value: number;
  /** What is said of a value; the number itself where nothing is given. */
  readonly words?: (value: number) => string;
}

/** oninput while it moves, onchange when it is let go. */
export function slider(label: string, range: SliderRange, on: { input?: (value: number) => void; change?: (value: number) => void }): Slider {
  const words = range.words ?? String;
  const output = h('output', {}, words(range.value));
  const input = h('input', {
    type: 'range',
    min: range.min,
    max: range.max,
    step: range.step,
    value: range.value,
    oninput: () => {
      output.textContent = words(input.valueAsNumber);
      on.input?.(input.valueAsNumber);
    },
    onchange: () => on.change?.(input.valueAsNumber),
  });
  const set = (value: number): void => {
    input.value = String(value);
    output.textContent = words(input.valueAsNumber);
  };
  return { element: h('label', { class: 'row' }, h('span', {}, label), input, output), input, set };
}

/** A part of the panel that opens and closes. */
export function section(title: string, open: boolean, ...children: Child[]): HTMLDetailsElement {
  return h('details', { open, class: 'section' }, h('summary', {}, h('h2', {}, title)), h('div', { class: 'section-body' }, ...children));
}

/** A button that asks for a file. */
export function fileButton(text: string, label: string, take: (name: string, bytes: Uint8Array) => void): { element: HTMLSpanElement; input: HTMLInputElement } {
  const input = h('input', {
    type: 'file',
    'aria-label': label,
    onchange: () => {
      const file = input.files?.[0];
      if (file) void file.arrayBuffer().then((bytes) => take(file.name, new Uint8Array(bytes)));
    },
  });
  return { element: h('span', { class: 'file' }, text, input), input };
}
