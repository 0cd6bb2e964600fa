/*
 * A room in three dimensions, drawn by plotly: what always stands there, and one of several states
 * (poses, placements) to choose from. The view is kept when the state changes.
 */

const ROOM_AXIS = {
  backgroundcolor: '#f5f7f9',
  showbackground: true,
  gridcolor: '#dfe3e8',
  zerolinecolor: '#9aa3ad',
  showspikes: false,
};
const ROOM_CONFIG = { responsive: true, displaylogo: false, displayModeBar: false };

function drawRoom(block) {
  const axis = (name) => ({ ...ROOM_AXIS, title: { text: `${name} / mm` } });
  // Plotly writes into what it is given: each state gets a layout of its own.
  const layout = () => ({
    template: PLOT_TEMPLATE,
    height: block.height_px,
    margin: { l: 0, r: 0, t: 0, b: 0 },
    uirevision: 'kept',
    scene: {
      aspectmode: 'data',
      xaxis: axis('x'),
      yaxis: axis('y'),
      zaxis: axis('z'),
      camera: { up: block.up, eye: block.eye, center: { x: 0, y: 0, z: 0 } },
      uirevision: 'kept',
    },
    legend: { orientation: 'h', y: 0, yanchor: 'top' },
  });
  const host = el('div', { className: 'plot room' });
  host.setAttribute('role', 'img');
  host.setAttribute('aria-label', plainText(block.caption));
  const show = (state) =>
    Plotly.react(host, [...block.traces, ...block.states[state].traces], layout(), ROOM_CONFIG);
  const choice = el(
    'select',
    { onchange: () => show(choice.selectedIndex) },
    ...block.states.map((state) => el('option', {}, state.label)),
  );
  afterLayout.push(() => show(0));
  const hint = el('p', { className: 'hint' }, 'Drag to turn, scroll or pinch to zoom; a click on a name of the legend takes it away.');
  const label = el('label', { className: 'choice' }, `${block.choice}: `, choice);
  return figure('Figure', block.caption, ...(block.states.length > 1 ? [label] : []), host, hint);
}
