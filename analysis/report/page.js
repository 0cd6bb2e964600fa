/*
 * Draws the report from its content, the JSON in the element #content. Each kind of block that needs
 * more than a few lines has a file of its own (report.cpp lists them); the page carries this one last.
 *
 * @typedef {{schema: "retrolux/report-1", title: string, subtitle: string, blocks: Block[]}}
 *   Content
 * @typedef {{type: "heading", text: string}
 *   | {type: "paragraph", text: string}   plain text with **bold** and `code`
 *   | {type: "key_figures", items: {label: string, value: string, unit: string, note: string}[]}
 *   | {type: "plot", caption: string, data: object[], layout: object, height_px: number}   plotly's
 *   | {type: "table", caption: string, columns: string[], rows: string[][]}
 *   | {type: "pictures", caption: string, columns: number,
 *      items: {label: string, png: string}[], legend?: Category[]}   base64
 *   | {type: "comparison", caption: string, items: {label: string, png: string}[]}   left and right
 *   | {type: "channels", caption: string, width: number, height: number,
 *      channels: Channel[]}   see channels.js
 *   | {type: "room", caption: string, height_px: number, up: object, eye: object,
 *      traces: object[], choice: string, states: {label: string, traces: object[]}[]}   plotly's
 *   | {type: "oval_maps", caption: string, categories: Category[], maps: OvalMap[],
 *      grid: Grid}   see oval.js
 *   | {type: "attachment", file_name: string, text: string}} Block
 *
 * Text only ever becomes text nodes: nothing in the content can become markup.
 */

/** An element with properties and children (strings become text). */
function el(tag, properties, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

const slug = (text) =>
  text
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, '-')
    .replace(/^-|-$/g, '')
    .slice(0, 60);

/** `text` as nodes, **bold** and `code` set as such. */
function richText(text) {
  return text.split(/(\*\*[^*]+\*\*|`[^`]+`)/).map((part) => {
    if (/^\*\*.+\*\*$/s.test(part)) return el('strong', {}, part.slice(2, -2));
    if (/^`.+`$/s.test(part)) return el('code', {}, part.slice(1, -1));
    return part;
  });
}

/** `text` without its marks, for places that take no nodes. */
const plainText = (text) => text.replace(/\*\*|`/g, '');

// --- downloads ---

function download(fileName, text, type) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el('a', { href: url, download: fileName }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

function downloadButton(label, fileName, text, type) {
  return el(
    'button',
    { type: 'button', className: 'download', onclick: () => download(fileName, text(), type) },
    label,
  );
}

function csvText(block) {
  const cell = (text) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return [block.columns, ...block.rows].map((row) => row.map(cell).join(',') + '\n').join('');
}

const sizeText = (bytes) =>
  bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`;

// --- figures, numbered by kind ---

const numbers = { Figure: 0, Table: 0 };

function figure(kind, caption, ...children) {
  numbers[kind] += 1;
  const name = `${kind} ${numbers[kind]}`;
  return el(
    'figure',
    { id: slug(name) },
    el('figcaption', {}, el('b', {}, name), ...richText(caption)),
    ...children,
  );
}

// --- tables ---

function drawTable(block) {
  const numeric = block.columns.map((_, c) =>
    block.rows.every((row) => /^([-+\u2212]?[\d., ]*\d(e[-+]?\d+)?\s*%?|[-\u2013]?)$/.test(row[c])),
  );
  const cells = (tag, row) =>
    row.map((text, c) => el(tag, { className: numeric[c] ? 'number' : '' }, text));
  const table = el(
    'table',
    {},
    el('thead', {}, el('tr', {}, ...cells('th', block.columns))),
    el('tbody', {}, ...block.rows.map((row) => el('tr', {}, ...cells('td', row)))),
  );
  const scroller = el('div', { className: 'table', tabIndex: 0 }, table);
  scroller.setAttribute('role', 'region');
  scroller.setAttribute('aria-label', plainText(block.caption));
  return figure(
    'Table',
    block.caption,
    scroller,
    downloadButton(
      'Download as CSV',
      `${slug(block.caption)}.csv`,
      () => csvText(block),
      'text/csv',
    ),
  );
}

// --- maps ---

/** What colours mean. */
function drawLegend(categories) {
  const swatch = (category) => {
    const mark = el('i', {});
    mark.style.background = category.colour;
    return el('li', {}, mark, category.label);
  };
  return el('ul', { className: 'legend' }, ...categories.map(swatch));
}

function drawOvalMaps(block) {
  const geometry = new OvalGeometry(block.grid);
  const maps = el(
    'div',
    { className: 'maps' },
    ...block.maps.map((map) =>
      el(
        'section',
        { className: 'map' },
        el('header', {}, el('b', {}, map.label), el('span', {}, map.note)),
        ovalSvg(geometry, map, block.categories),
      ),
    ),
  );
  followPointer(maps, geometry, block.maps, block.categories, tip);
  return figure(
    'Figure',
    block.caption,
    drawLegend(block.categories),
    maps,
  );
}

// --- the rest ---

function drawHeading(block) {
  let id = slug(block.text) || 'section';
  while (document.getElementById(id) || sections.some((section) => section.id === id)) id += '-';
  const heading = el('h2', { id }, block.text);
  sections.push(heading);
  return heading;
}

function drawKeyFigures(block) {
  return el(
    'dl',
    { className: 'key-figures' },
    ...block.items.map((item) =>
      el(
        'div',
        {},
        el('dt', {}, item.label),
        el('dd', { className: 'value' }, item.value, el('span', { className: 'unit' }, item.unit)),
        ...(item.note ? [el('dd', { className: 'note' }, item.note)] : []),
      ),
    ),
  );
}

function drawAttachment(block) {
  return el(
    'p',
    { className: 'attachment' },
    downloadButton(block.file_name, block.file_name, () => block.text, 'text/plain'),
    el('span', { className: 'size' }, ` ${sizeText(new Blob([block.text]).size)}`),
  );
}

/** Table of contents; the section that one reads is marked. */
function drawContents() {
  const links = new Map(
    sections.map((section) => [section, el('a', { href: `#${section.id}` }, section.textContent)]),
  );
  const details = el(
    'details',
    { open: window.matchMedia('(min-width: 60rem)').matches },
    el('summary', {}, 'Contents'),
    el('ol', {}, ...[...links.values()].map((link) => el('li', {}, link))),
  );
  document.querySelector('.contents').append(...(sections.length ? [details] : []));
  const mark = () => {
    const current = sections.findLast((section) => section.getBoundingClientRect().top < 160);
    links.forEach((link, section) => link.toggleAttribute('aria-current', section === current));
  };
  window.addEventListener('scroll', mark, { passive: true });
  mark();
}

/** One row for each kind of block. */
const DRAW = {
  heading: drawHeading,
  paragraph: (block) => el('p', {}, ...richText(block.text)),
  key_figures: drawKeyFigures,
  plot: drawPlot,
  table: drawTable,
  pictures: drawPictures,
  comparison: drawComparison,
  channels: drawChannels,
  room: drawRoom,
  oval_maps: drawOvalMaps,
  attachment: drawAttachment,
};

const sections = [];
const afterLayout = [];
const viewer = new Viewer();
const tip = document.body.appendChild(el('div', { className: 'tip', hidden: true }));

function drawReport() {
  const content = JSON.parse(document.getElementById('content').textContent);
  const header = el(
    'header',
    {},
    el('h1', {}, content.title),
    el('p', { className: 'subtitle' }, content.subtitle),
  );
  document
    .querySelector('main')
    .append(header, ...content.blocks.map((block) => DRAW[block.type](block)));
  drawContents();
  fitPlotsToPaper();
  return Promise.all(afterLayout.map((draw) => draw())).then(() => {
    document.body.dataset.ready = 'true';
  });
}

drawReport();
