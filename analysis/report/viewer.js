/*
 * Pictures: small ones in the page, and the viewer that shows them pixel by pixel.
 */

function drawPictures(block) {
  const items = block.items.map((item) => ({
    label: item.label || plainText(block.caption),
    source: `data:image/png;base64,${item.png}`,
  }));
  const buttons = items.map((item, index) => {
    const image = el('img', { src: item.source, alt: item.label });
    const button = el(
      'button',
      { type: 'button', className: 'picture', onclick: () => viewer.open(items, index) },
      image,
    );
    image.addEventListener('load', () =>
      button.classList.toggle('small', image.naturalWidth < 320),
    );
    if (block.items[index].label) button.append(el('span', {}, item.label));
    return button;
  });
  const grid = el(
    'div',
    { className: `pictures${items.length === 1 ? ' single' : ''}` },
    ...buttons,
  );
  grid.style.setProperty('--columns', block.columns);
  const legend = block.legend ? [drawLegend(block.legend)] : [];
  return figure('Figure', block.caption, ...legend, grid);
}

/** One picture at a time: + and - zoom, 0 fits, the arrow keys turn the page, Escape closes. */
class Viewer {
  constructor() {
    this.image = el('img', { onclick: () => this.zoom(2) });
    this.stage = el('div', { className: 'stage' }, this.image);
    this.label = el('span', {});
    const button = (text, title, onclick) =>
      el('button', { type: 'button', title, ariaLabel: title, onclick }, text);
    this.turns = [
      button('\u2190', 'Previous picture', () => this.turn(-1)),
      button('\u2192', 'Next picture', () => this.turn(1)),
    ];
    this.dialog = el(
      'dialog',
      { className: 'viewer', ariaLabel: 'Picture viewer' },
      this.stage,
      el(
        'footer',
        {},
        this.label,
        ...this.turns,
        button('\u2212', 'Smaller', () => this.zoom(0.5)),
        button('Fit', 'Fit to window', () => this.fit()),
        button('+', 'Larger', () => this.zoom(2)),
        button('\u2715', 'Close', () => this.dialog.close()),
      ),
    );
    this.dialog.addEventListener('keydown', (event) => this.key(event));
    this.image.addEventListener('load', () => this.fit());
    document.body.append(this.dialog);
  }

  open(items, index) {
    this.items = items;
    this.turns.forEach((button) => {
      button.hidden = items.length < 2;
    });
    this.dialog.showModal();
    this.show(index);
  }

  show(index) {
    this.index = index;
    Object.assign(this.image, { src: this.items[index].source, alt: this.items[index].label });
    this.fit();
  }

  turn(step) {
    this.show((this.index + step + this.items.length) % this.items.length);
  }

  /** As large as the window allows; enlarged by a whole number, so that all pixels are equal. */
  fit() {
    const { naturalWidth: width, naturalHeight: height } = this.image;
    if (!width) return;
    const scale = Math.min(this.stage.clientWidth / width, this.stage.clientHeight / height);
    this.setScale(scale > 1 ? Math.floor(scale) : scale);
  }

  zoom(factor) {
    this.setScale(Math.min(64, Math.max(1 / 8, this.scale * factor)));
  }

  /** Keeps what is in the middle of the window there. */
  setScale(scale) {
    const stage = this.stage;
    const middle = [
      (stage.scrollLeft + stage.clientWidth / 2) / stage.scrollWidth,
      (stage.scrollTop + stage.clientHeight / 2) / stage.scrollHeight,
    ];
    this.scale = scale;
    this.image.style.width = `${this.image.naturalWidth * scale}px`;
    stage.scrollLeft = middle[0] * stage.scrollWidth - stage.clientWidth / 2;
    stage.scrollTop = middle[1] * stage.scrollHeight - stage.clientHeight / 2;
    this.label.textContent = `${this.items[this.index].label} \u00b7 ${Math.round(100 * scale)} %`;
  }

  key(event) {
    const actions = {
      '+': () => this.zoom(2),
      '=': () => this.zoom(2),
      '-': () => this.zoom(0.5),
      0: () => this.fit(),
      ArrowLeft: () => this.turn(-1),
      ArrowRight: () => this.turn(1),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
  }
}
