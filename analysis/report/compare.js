/*
 * Two pictures of the same size, one over the other: the slider moves the line between them.
 */

function drawComparison(block) {
  const side = (item, className) =>
    el(
      'div',
      { className },
      el('img', { src: `data:image/png;base64,${item.png}`, alt: item.label }),
      el('span', {}, item.label),
    );
  const [left, right] = block.items;
  const stage = el('div', { className: 'comparison' }, side(right, 'after'), side(left, 'before'));
  const slider = el('input', {
    type: 'range',
    min: 0,
    max: 100,
    step: 0.5,
    value: 50,
    ariaLabel: `Line between ${left.label} and ${right.label}`,
    oninput: () => stage.style.setProperty('--line', `${slider.value}%`),
  });
  return figure('Figure', block.caption, el('div', { className: 'slid' }, stage, slider));
}
