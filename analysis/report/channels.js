/*
 * Channels of a picture, value by value: in false colour with a scale, ids in colours of their own,
 * the value under the pointer beside it.
 *
 * @typedef {{name: string, unit: string, kind: "value" | "difference" | "ids", names: string[],
 *   data: string}} Channel   data: base64 of zlib of the values, 32-bit floats row by row
 */

// Stops of viridis and of a scale from blue over white to red (RdBu): both for the colour-blind.
const SEQUENTIAL = ['#440154', '#443983', '#31688e', '#21918c', '#35b779', '#90d743', '#fde725'];
const DIVERGING = ['#2166ac', '#67a9cf', '#d1e5f0', '#f7f7f7', '#fddbc7', '#ef8a62', '#b2182b'];
const NO_VALUE = [90, 96, 104];

const rgbOf = (colour) => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));

/** 256 colours between the stops. */
function colourTable(stops) {
  const colours = stops.map(rgbOf);
  return Array.from({ length: 256 }, (_, i) => {
    const place = (i / 255) * (stops.length - 1);
    const stop = Math.min(stops.length - 2, Math.floor(place));
    const mix = (k) => colours[stop][k] + (place - stop) * (colours[stop + 1][k] - colours[stop][k]);
    return [0, 1, 2].map((k) => Math.round(mix(k)));
  });
}

/** Ids next to each other are far apart in hue: the golden angle. */
function colourOfId(id) {
  if (!id) return [0, 0, 0];
  const hue = (id * 137.508) % 360;
  const part = (n) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (0.6 - 0.35 * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [part(0), part(8), part(4)];
}

async function unpack(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Float32Array(await new Response(stream).arrayBuffer());
}

/** What holds all finite values but the highest thousandth, where highlights are. */
function usualRange(channel, values) {
  const finite = Float32Array.from(values.filter(Number.isFinite)).sort();
  if (!finite.length) return [0, 1];
  if (channel.kind === 'difference') {
    const most = Math.max(-finite[0], finite[finite.length - 1]) || 1;
    return [-most, most];
  }
  const high = finite[Math.floor(0.999 * (finite.length - 1))];
  return [finite[0], high > finite[0] ? high : finite[0] + 1];
}

const numberText = (value) => (Number.isFinite(value) ? String(+value.toPrecision(6)) : 'no value');

class ChannelView {
  constructor(block) {
    this.block = block;
    this.canvas = el('canvas', { width: block.width, height: block.height });
    this.canvas.setAttribute('role', 'img');
    this.bar = el('canvas', { width: 256, height: 1, className: 'scale' });
    this.reading = el('output', { className: 'reading' }, 'Point at a pixel to read its value.');
    const change = { onchange: () => this.draw() };
    this.low = el('input', { type: 'number', step: 'any', ariaLabel: 'Lowest value', ...change });
    this.high = el('input', { type: 'number', step: 'any', ariaLabel: 'Highest value', ...change });
    this.log = el('input', { type: 'checkbox', ...change });
    this.choice = el(
      'select',
      { onchange: () => this.show(this.choice.selectedIndex) },
      ...block.channels.map(({ name, unit }) => el('option', {}, unit ? `${name} / ${unit}` : name)),
    );
    const zoom = (text, title, factor) =>
      el('button', { type: 'button', title, ariaLabel: title, onclick: () => this.zoom(factor) }, text);
    this.scaleRow = el(
      'div',
      { className: 'scale-row' },
      this.low,
      this.bar,
      this.high,
      el('label', {}, this.log, ' logarithmic'),
      el('button', { type: 'button', onclick: () => this.fitScale() }, 'Usual range'),
    );
    this.legend = el('div', {});
    this.stage = el('div', { className: 'channel-stage', tabIndex: 0 }, this.canvas);
    this.node = el(
      'div',
      { className: 'channels' },
      el(
        'div',
        { className: 'scale-row' },
        el('label', {}, 'Channel: ', this.choice),
        zoom('\u2212', 'Smaller', 0.5),
        zoom('Fit', 'Fit to the page', 0),
        zoom('+', 'Larger', 2),
      ),
      this.scaleRow,
      this.legend,
      this.stage,
      this.reading,
    );
    this.canvas.addEventListener('pointermove', (event) => this.read(event));
    this.unpacked = [];
  }

  async show(index) {
    this.channel = this.block.channels[index];
    this.unpacked[index] ??= await unpack(this.channel.data);
    this.values = this.unpacked[index];
    this.canvas.setAttribute('aria-label', `${this.channel.name} in false colour`);
    const ids = this.channel.kind === 'ids';
    this.scaleRow.hidden = ids;
    this.legend.replaceChildren(...(ids ? [this.namesOfIds()] : []));
    if (ids) this.draw();
    else this.fitScale();
  }

  namesOfIds() {
    const found = [...new Set(this.values)].filter((id) => id > 0).sort((a, b) => a - b);
    const label = (id) => `${id} ${this.channel.names[id - 1] ?? ''}`;
    const few = found.slice(0, 24).map((id) => ({
      label: label(id),
      colour: `rgb(${colourOfId(id).join(',')})`,
    }));
    if (found.length > few.length)
      few.push({ label: `and ${found.length - few.length} more`, colour: 'transparent' });
    return drawLegend(few);
  }

  fitScale() {
    [this.low.value, this.high.value] = usualRange(this.channel, this.values).map(
      (value) => +value.toPrecision(4),
    );
    this.draw();
  }

  colours() {
    if (this.channel.kind === 'ids') return colourOfId;
    const table = colourTable(this.channel.kind === 'difference' ? DIVERGING : SEQUENTIAL);
    const low = Number(this.low.value);
    const high = Number(this.high.value);
    // A logarithm of what is not positive has none: such values get the lowest colour.
    const floor = Math.max(low, high / 1e4);
    const place = this.log.checked
      ? (value) => Math.log(Math.max(value, floor) / floor) / Math.log(high / floor)
      : (value) => (value - low) / (high - low);
    return (value) =>
      Number.isFinite(value)
        ? table[Math.round(255 * Math.min(1, Math.max(0, place(value))))] ?? table[0]
        : NO_VALUE;
  }

  draw() {
    const colour = this.colours();
    const paint = (canvas, values) => {
      const context = canvas.getContext('2d');
      const image = context.createImageData(canvas.width, canvas.height);
      values.forEach((value, i) => image.data.set([...colour(value), 255], 4 * i));
      context.putImageData(image, 0, 0);
    };
    paint(this.canvas, this.values);
    const low = Number(this.low.value);
    const step = (Number(this.high.value) - low) / 255;
    if (this.channel.kind !== 'ids') paint(this.bar, Float32Array.from({ length: 256 }, (_, i) => low + i * step));
  }

  /** By a factor; 0: as wide as the page. */
  zoom(factor) {
    const width = this.canvas.getBoundingClientRect().width;
    this.canvas.style.width = factor ? `${Math.min(16 * this.block.width, width * factor)}px` : '';
  }

  read(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = (offset, size, pixels) =>
      Math.min(pixels - 1, Math.max(0, Math.floor((offset / size) * pixels)));
    const u = at(event.clientX - box.left, box.width, this.block.width);
    const v = at(event.clientY - box.top, box.height, this.block.height);
    const value = this.values[v * this.block.width + u];
    const { kind, names, name, unit } = this.channel;
    const text = kind === 'ids' ? `${value} ${names[value - 1] ?? ''}` : `${numberText(value)} ${unit}`;
    this.reading.textContent = `pixel (${u}, ${v}): ${name} = ${text.trim()}`;
  }
}

function drawChannels(block) {
  const view = new ChannelView(block);
  afterLayout.push(() => view.show(0));
  return figure('Figure', block.caption, view.node);
}
