/*
 * Plots by plotly, with the look of the page: what a figure does not say itself comes from here.
 */

// Okabe and Ito (2008): told apart by the colour-blind; the yellow is left out, too pale for lines.
const COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#1a1a1a'];
const FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
const PRINT_WIDTH_PX = 660;
const PLOT_AXIS = {
  automargin: true,
  gridcolor: '#e6e9ed',
  linecolor: '#9aa3ad',
  zerolinecolor: '#c3c9d0',
  ticks: 'outside',
  tickcolor: '#9aa3ad',
  ticklen: 4,
  showline: true,
  title: { standoff: 10, font: { size: 13 } },
};
const PLOT_TEMPLATE = {
  layout: {
    colorway: COLOURS,
    font: { family: FONT, size: 13, color: '#1a1d21' },
    paper_bgcolor: '#fff',
    plot_bgcolor: '#fff',
    margin: { l: 56, r: 18, t: 34, b: 48 },
    xaxis: PLOT_AXIS,
    yaxis: PLOT_AXIS,
    legend: {
      orientation: 'h',
      x: 0,
      xanchor: 'left',
      y: 1.02,
      yanchor: 'bottom',
      traceorder: 'normal',
    },
    colorscale: { sequential: 'Cividis', sequentialminus: 'Cividis' },
    hoverlabel: { font: { family: FONT } },
    bargap: 0.25,
  },
  data: {
    scatter: [{ line: { width: 2 }, marker: { size: 7 }, error_y: { thickness: 1.2, width: 4 } }],
    heatmap: [{ colorscale: 'Cividis', colorbar: { outlinewidth: 0, thickness: 14 } }],
  },
};
const touch = window.matchMedia('(pointer: coarse)').matches;

function drawPlot(block) {
  const host = el('div', { className: 'plot' });
  host.setAttribute('role', 'img');
  host.setAttribute('aria-label', plainText(block.caption));
  // A finger scrolls the page, a mouse zooms.
  const layout = {
    template: PLOT_TEMPLATE,
    height: block.height_px,
    ...(touch && { dragmode: false }),
    ...block.layout,
  };
  const config = {
    responsive: true,
    displaylogo: false,
    displayModeBar: touch ? false : 'hover',
    showSendToCloud: false,
    plotlyServerURL: '', // its button "Share chart" would upload the data
    modeBarButtonsToRemove: ['select2d', 'lasso2d', 'autoScale2d'],
  };
  afterLayout.push(() => Plotly.newPlot(host, block.data, layout, config));
  return figure('Figure', block.caption, host);
}

/** Plots are as wide as the window; on paper they must be as wide as the page. */
function fitPlotsToPaper() {
  const plots = () => document.querySelectorAll('.plot');
  window.addEventListener('beforeprint', () =>
    plots().forEach((plot) => {
      Plotly.relayout(plot, { width: PRINT_WIDTH_PX, autosize: false });
    }),
  );
  window.addEventListener('afterprint', () =>
    plots().forEach((plot) => {
      Plotly.relayout(plot, { width: null, autosize: true });
    }),
  );
}
