'use strict';
/*
 * Maps of marker positions on the top half of an ellipsoid of revolution: unrolled, and painted on
 * the oval in third-angle projection. World axes: x up, z to the front, y to the left of an
 * observer who faces the scanner. One SVG a map, its unit 1 mm; one path for all cells of a
 * category in a view.
 *
 * @typedef {{rows: number, columns: number, half_length_mm: number, radius_mm: number}} Grid
 *   columns are those of one side; row 0 at -half_length, column 0 at the top
 * @typedef {{label: string, note: string, values: number[][]}} OvalMap
 *   values[row][k]: index of the category; k from the left side (y > 0) over the top to the right
 * @typedef {{label: string, colour: string}} Category
 */

/** Views: page right, page up and towards the viewer, each a world axis as [axis index, sign]. */
const OVAL_VIEWS = [
  { id: 'top', name: 'Above', right: [1, -1], up: [2, -1], eye: [0, 1] },
  { id: 'side', name: 'Left side', right: [2, 1], up: [0, 1], eye: [1, 1] },
  { id: 'front', name: 'Front', right: [1, -1], up: [0, 1], eye: [2, 1] },
];
const SVG_NS = 'http://www.w3.org/2000/svg';
const SCALE_BAR_MM = 50;

/** An SVG element with attributes and children (strings become text). */
function svg(tag, attributes, ...children) {
  const node = document.createElementNS(SVG_NS, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const shortNumber = (value) => String(Math.round(value * 10) / 10);
const signed = (value) => (value < 0 ? '\u2212' : '') + shortNumber(Math.abs(value));

/** What all maps of a block share: where the views lie on the page, the outline of each cell. */
class OvalGeometry {
  /** @param {Grid} grid */
  constructor(grid) {
    this.grid = grid;
    this.semi = [grid.radius_mm, grid.radius_mm, grid.half_length_mm];
    const { radius_mm: r, half_length_mm: h } = grid;
    const left = 62,
      top = 32,
      gap = 62,
      below = 86;
    this.origin = {
      // of each view on the page, in SVG units
      grid: [left, top],
      top: [left + 2 * h + gap + r, top + h],
      side: [left + h, top + 2 * h + below + r],
      front: [left + 2 * h + gap + r, top + 2 * h + below + r],
    };
    this.size = [left + 2 * h + gap + 2 * r + 12, top + 2 * h + below + r + 32];
    this.cells = {};
    for (const id of ['grid', ...OVAL_VIEWS.map((view) => view.id)])
      this.cells[id] = this.outlines(id);
  }

  /** Path data of each cell in a view, [row][k]; empty for cells that face away. */
  outlines(id) {
    const view = OVAL_VIEWS.find((v) => v.id === id);
    const { rows, columns } = this.grid;
    return Array.from({ length: rows }, (_, row) =>
      Array.from({ length: 2 * columns }, (_, k) => {
        if (!view)
          return this.path(
            id,
            [
              [k, row],
              [k + 1, row],
              [k + 1, row + 1],
              [k, row + 1],
            ].map((corner) => this.unrolled(...corner)),
          );
        const [axis, sign] = view.eye;
        if (this.point(row + 0.5, k + 0.5)[axis] * sign <= 0) return '';
        return this.path(
          id,
          this.border(row, k).map((point) => this.project(view, point)),
        );
      }),
    );
  }

  /** Page offsets of a corner of the unrolled grid, a square as long as the oval. */
  unrolled(k, row) {
    const side = 2 * this.grid.half_length_mm;
    return [(k * side) / (2 * this.grid.columns), (row * side) / this.grid.rows];
  }

  /** The point of the surface at a row and k that need not be whole. */
  point(row, k) {
    const { rows, columns, half_length_mm: h, radius_mm: r } = this.grid;
    const z = -h + (2 * h * row) / rows;
    const rho = r * Math.sqrt(Math.max(0, 1 - (z / h) ** 2));
    const phi = ((columns - k) * Math.PI) / 2 / columns;
    return [rho * Math.cos(phi), rho * Math.sin(phi), z];
  }

  /** Corners of a cell; its edges along the meridian, which bend much at the ends, in steps. */
  border(row, k) {
    const steps = [0, 0.3, 0.6, 0.85, 0.97, 1];
    const bent = row < this.grid.rows / 2 ? steps.map((t) => 1 - t).reverse() : steps;
    return [
      ...bent.map((t) => this.point(row + t, k)),
      ...bent.map((t) => this.point(row + t, k + 1)).reverse(),
    ];
  }

  project(view, point) {
    return [point[view.right[0]] * view.right[1], -point[view.up[0]] * view.up[1]];
  }

  path(id, points) {
    const [x, y] = this.origin[id];
    return (
      'M' + points.map((p) => shortNumber(x + p[0]) + ' ' + shortNumber(y + p[1])).join('L') + 'Z'
    );
  }

  /** The cell [row, k] under a point of the page, or null. */
  cellAt(id, x, y) {
    const u = x - this.origin[id][0],
      v = y - this.origin[id][1];
    const { rows, columns, half_length_mm: h } = this.grid;
    let row = (v * rows) / (2 * h),
      k = (u * columns) / h;
    const view = OVAL_VIEWS.find((candidate) => candidate.id === id);
    if (view) {
      const p = this.unproject(view, u, -v);
      row = ((p[2] + h) * rows) / (2 * h);
      k = columns - (Math.atan2(p[1], Math.max(0, p[0])) * 2 * columns) / Math.PI;
    }
    const clamp = (value, count) => Math.min(count - 1, Math.max(0, Math.floor(value)));
    return [clamp(row, rows), clamp(k, 2 * columns)];
  }

  /** The point of the surface that the viewer sees at (u, v), v upwards. */
  unproject(view, u, v) {
    const point = [0, 0, 0];
    point[view.right[0]] = u * view.right[1];
    point[view.up[0]] = v * view.up[1];
    const rest = point.reduce((sum, c, axis) => sum - (c / this.semi[axis]) ** 2, 1);
    point[view.eye[0]] = view.eye[1] * this.semi[view.eye[0]] * Math.sqrt(Math.max(0, rest));
    return point;
  }

  /** What a person wants to know of a cell, without its value. */
  describe(row, k) {
    const { rows, columns, half_length_mm: h } = this.grid;
    const column = k < columns ? columns - 1 - k : k - columns;
    const z = -h + (2 * h * (row + 0.5)) / rows,
      angle = ((column + 0.5) * 90) / columns;
    return (
      `row ${row}, column ${column}, ${k < columns ? 'left (y > 0)' : 'right (y < 0)'}\n` +
      `z ${signed(z)} mm, ${shortNumber(angle)}° from the top`
    );
  }
}

/** Outline, axes and name of a view; the parts of the picture that are the same in every map. */
function viewFrame(geometry, view) {
  const [x, y] = geometry.origin[view.id];
  const a = geometry.semi[view.right[0]],
    b = geometry.semi[view.up[0]];
  const whole = view.id === 'top';
  const reach = 12,
    axisNames = 'xyz';
  const tip = view.right[1] * (a + reach),
    upTip = -view.up[1] * (b + reach);
  const outline = whole
    ? `M${x - a} ${y}a${a} ${b} 0 1 1 ${2 * a} 0a${a} ${b} 0 1 1 ${-2 * a} 0Z`
    : `M${x - a} ${y}a${a} ${b} 0 0 1 ${2 * a} 0Z`;
  const edge = x + tip - Math.sign(tip) * reach;
  const upEdge = y + upTip - Math.sign(upTip) * reach;
  const axes = `M${edge} ${y}H${x + tip}M${x} ${upEdge}V${y + upTip}`;
  return svg(
    'g',
    {},
    svg('path', { class: 'outline', d: outline }),
    svg('path', { class: 'axis', d: axes }),
    svg('text', { class: 'name', x: x - a, y: y - b - 10 }, view.name),
    svg(
      'text',
      { x: x + tip + Math.sign(tip) * 3, y: y + 5, 'text-anchor': tip > 0 ? 'start' : 'end' },
      axisNames[view.right[0]],
    ),
    svg('text', { x: x + 5, y: y + upTip + (upTip > 0 ? 10 : 3) }, axisNames[view.up[0]]),
  );
}

/** Name and tick labels of the unrolled grid. */
function gridFrame(geometry) {
  const [x, y] = geometry.origin.grid,
    h = geometry.grid.half_length_mm;
  const tick = (tx, ty, text, anchor) => svg('text', { x: tx, y: ty, 'text-anchor': anchor }, text);
  const middle = `translate(${x - 42} ${y + h}) rotate(-90)`;
  return svg(
    'g',
    {},
    svg('text', { class: 'name', x, y: y - 10 }, 'Unrolled'),
    tick(x - 6, y + 11, signed(-h), 'end'),
    tick(x - 6, y + h + 5, '0', 'end'),
    tick(x - 6, y + 2 * h, signed(h), 'end'),
    svg('text', { transform: middle, 'text-anchor': 'middle' }, '\u2190 front z (mm) rear \u2192'),
    tick(x, y + 2 * h + 20, '90° left', 'start'),
    tick(x + h, y + 2 * h + 20, 'top', 'middle'),
    tick(x + 2 * h, y + 2 * h + 20, '90° right', 'end'),
  );
}

function scaleBar(geometry) {
  const [x, y] = geometry.origin.front,
    end = x + geometry.grid.radius_mm;
  return svg(
    'g',
    {},
    svg('path', { class: 'axis', d: `M${end - SCALE_BAR_MM} ${y + 14}v6h${SCALE_BAR_MM}v-6` }),
    svg(
      'text',
      { x: end - SCALE_BAR_MM - 6, y: y + 23, 'text-anchor': 'end' },
      `${SCALE_BAR_MM} mm`,
    ),
  );
}

/** The cells of one view, a path for each category that occurs. */
function viewCells(geometry, id, map, categories) {
  const paths = categories.map(() => '');
  geometry.cells[id].forEach((line, row) =>
    line.forEach((d, k) => {
      paths[map.values[row][k]] += d;
    }),
  );
  const group = svg('g', { class: 'cells', 'data-view': id });
  paths.forEach((d, index) => {
    if (d) group.append(svg('path', { fill: categories[index].colour, d }));
  });
  return group;
}

/** "hit 120, miss 664 of 784 positions", for those who do not see the map. */
function countsText(map, categories) {
  const counts = categories.map(() => 0);
  for (const line of map.values) for (const value of line) counts[value] += 1;
  const total = counts.reduce((sum, count) => sum + count, 0);
  return (
    categories.map((category, i) => `${category.label} ${counts[i]}`).join(', ') +
    ` of ${total} positions`
  );
}

/** @param {OvalGeometry} geometry @param {OvalMap} map @param {Category[]} categories */
function ovalSvg(geometry, map, categories) {
  const ids = Object.keys(geometry.cells);
  return svg(
    'svg',
    {
      class: 'oval',
      viewBox: `0 0 ${geometry.size.join(' ')}`,
      role: 'img',
      'aria-label': `${map.label}: ${countsText(map, categories)}`,
    },
    ...ids.map((id) => viewCells(geometry, id, map, categories)),
    gridFrame(geometry),
    ...OVAL_VIEWS.map((view) => viewFrame(geometry, view)),
    scaleBar(geometry),
    svg('path', { class: 'mark' }),
  );
}

/** Pointing at a cell marks it in every view of every map of the block, and tells what it is. */
function followPointer(host, geometry, maps, categories, tip) {
  const marks = host.querySelectorAll('.mark');
  const clear = () => {
    marks.forEach((mark) => mark.setAttribute('d', ''));
    tip.hidden = true;
  };
  const show = (event) => {
    const group = event.target.closest('.cells');
    if (!group) return clear();
    const picture = group.ownerSVGElement;
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(
      picture.getScreenCTM().inverse(),
    );
    const [row, k] = geometry.cellAt(group.dataset.view, x, y);
    const d = Object.values(geometry.cells)
      .map((cells) => cells[row][k])
      .join('');
    marks.forEach((mark) => mark.setAttribute('d', d));
    const map = maps[[...host.querySelectorAll('.oval')].indexOf(picture)];
    const value = categories[map.values[row][k]].label;
    tip.textContent = `${map.label}: ${value}\n${geometry.describe(row, k)}`;
    tip.hidden = false;
    placeTip(tip, event.clientX, event.clientY);
  };
  host.addEventListener('pointermove', show);
  host.addEventListener('pointerdown', show);
  host.addEventListener('pointerleave', (event) => {
    if (event.pointerType === 'mouse') clear();
  });
}

/** Beside the pointer, inside the window. */
function placeTip(tip, x, y) {
  const left = Math.min(x + 14, window.innerWidth - tip.offsetWidth - 8);
  const above = y - tip.offsetHeight - 14;
  tip.style.transform = `translate(${Math.max(8, left)}px, ${above > 8 ? above : y + 18}px)`;
}
