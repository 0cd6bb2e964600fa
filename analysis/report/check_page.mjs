// Is a report whole? Opens it in Chromium, off line, and compares what was drawn with the content:
//     node check_page.mjs CHROMIUM REPORT.html SCREENSHOT_FOLDER
// Prints what is wrong and exits with 1, or one line of what was found and exits with 0.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [executablePath, report, pictures] = process.argv.slice(2);
const SIZES = { desktop: { width: 1440, height: 900 }, phone: { width: 390, height: 844 } };
const ARGS = [
  '--no-sandbox',
  '--disable-gpu',
  '--enable-unsafe-swiftshader', // three dimensions without a graphics card
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--no-first-run',
];

/** Runs in the page: what is wrong with it, as sentences. */
function faultsOfPage() {
  const faults = [];
  const { blocks } = JSON.parse(document.getElementById('content').textContent);
  const of = (type) => blocks.filter((block) => block.type === type);
  const expect = (what, found, expected) => {
    if (found !== expected) faults.push(`${what}: ${found}, expected ${expected}`);
  };
  const all = (selector) => [...document.querySelectorAll(selector)];

  const plots = all('.plot:not(.room)');
  expect('plots', plots.length, of('plot').length);
  of('plot').forEach((block, i) => {
    // An unknown type of trace silently becomes a scatter plot: compare the types.
    const types = (traces) => (traces ?? []).map((trace) => trace.type ?? 'scatter').join(' ');
    expect(`traces of "${block.caption}"`, types(plots[i]?._fullData), types(block.data));
    if (plots[i]?.querySelector('[data-title*="hare"]'))
      faults.push(`"${block.caption}" offers to upload its data`);
    if (!plots[i]?.querySelector('.main-svg')) faults.push(`"${block.caption}" is not drawn`);
  });

  const rooms = all('.room');
  expect('rooms', rooms.length, of('room').length);
  of('room').forEach((block, i) => {
    const types = (traces) => (traces ?? []).map((trace) => trace.type).join(' ');
    const expected = types([...block.traces, ...block.states[0].traces]);
    expect(`traces of "${block.caption}"`, types(rooms[i]?._fullData), expected);
    if (!rooms[i]?.querySelector('canvas')) faults.push(`"${block.caption}" is not drawn`);
  });
  expect('comparisons', all('.comparison').length, of('comparison').length);

  const channels = all('.channels');
  expect('pictures by channel', channels.length, of('channels').length);
  channels.forEach((node, i) => {
    const canvas = node.querySelector('.channel-stage canvas');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    if (new Set(new Uint32Array(data.buffer)).size < 2) faults.push(`channels ${i + 1}: one colour`);
  });

  const maps = all('.oval');
  const blockOfMap = of('oval_maps').flatMap((block) => block.maps.map(() => block));
  expect('oval maps', maps.length, blockOfMap.length);
  maps.forEach((map, i) => {
    const { rows, columns } = blockOfMap[i].grid;
    // Seen from above: all of the top half; from the side or the front: half of that.
    const cells = {
      grid: 2 * rows * columns,
      top: 2 * rows * columns,
      side: rows * columns,
      front: rows * columns,
    };
    for (const [view, count] of Object.entries(cells)) {
      const outlines = [...map.querySelectorAll(`[data-view=${view}] path`)]
        .map((p) => p.getAttribute('d'))
        .join('');
      expect(`cells of map ${i + 1}, ${view}`, outlines.split('M').length - 1, count);
      if (/NaN|undefined/.test(outlines)) faults.push(`map ${i + 1}, ${view}: not a number`);
    }
  });

  const images = all('.picture img');
  expect('pictures', images.length, of('pictures').flatMap((block) => block.items).length);
  images.forEach((image, i) => {
    if (!image.naturalWidth) faults.push(`picture ${i + 1} cannot be shown`);
  });
  expect(
    'rows of tables',
    all('tbody tr').length,
    of('table').flatMap((block) => block.rows).length,
  );
  expect('headings', all('h2').length, of('heading').length);
  all('img, .oval, .plot').forEach((node) => {
    if (!(node.alt || node.getAttribute('aria-label') || node.closest('dialog')))
      faults.push(`no alternative text: ${node.className}`);
  });
  if (document.documentElement.scrollWidth > window.innerWidth)
    faults.push('wider than the window');
  const ids = all('[id]')
    .map((node) => node.id)
    .filter((id) => /^(figure|table)-\d+$/.test(id));
  expect('numbered figures', new Set(ids).size, all('figure').length);
  return faults;
}

/** The viewer opens by keyboard, zooms and closes. */
async function faultsOfViewer(page) {
  if (!(await page.locator('.picture').count())) return [];
  const faults = [];
  const width = () =>
    page.locator('.viewer img').evaluate((image) => image.getBoundingClientRect().width);
  await page.locator('.picture').first().focus();
  await page.keyboard.press('Enter');
  if (!(await page.locator('.viewer[open]').count())) return ['the picture viewer does not open'];
  const before = await width();
  await page.keyboard.press('+');
  if (!((await width()) > 1.5 * before)) faults.push('the picture viewer does not zoom');
  await page.keyboard.press('0');
  await page.screenshot({ path: path.join(pictures, 'viewer.png') });
  await page.keyboard.press('Escape');
  if (await page.locator('.viewer[open]').count()) faults.push('the picture viewer does not close');
  return faults;
}

/** Pointing at the middle of a cell in a view names that cell. */
async function faultsOfTip(page) {
  if (!(await page.locator('.oval').count())) return [];
  const faults = [];
  for (const view of ['grid', 'top', 'side', 'front']) {
    const target = await page.evaluate((id) => {
      const { grid } = JSON.parse(document.getElementById('content').textContent).blocks.find(
        (b) => b.type === 'oval_maps',
      );
      const geometry = new OvalGeometry(grid);
      const row = Math.floor(grid.rows * 0.7),
        k = Math.floor(grid.columns * 0.6);
      const picture = document.querySelector('.oval');
      picture.scrollIntoView({ block: 'center', behavior: 'instant' });
      const probe = svg('path', { d: geometry.cells[id][row][k] });
      picture.append(probe);
      const box = probe.getBoundingClientRect();
      probe.remove();
      return {
        x: box.x + box.width / 2,
        y: box.y + box.height / 2,
        text: geometry.describe(row, k),
      };
    }, view);
    await page.mouse.move(target.x, target.y);
    const text = await page.locator('.tip').textContent();
    if (!text.endsWith(target.text))
      faults.push(`pointing at a cell, ${view}: "${text}", expected "${target.text}"`);
  }
  await page.screenshot({ path: path.join(pictures, 'tip.png') });
  await page.mouse.move(0, 0);
  return faults;
}

/** Pointing at a pixel reads its value, in each channel; the scale of ids is hidden. */
async function faultsOfChannels(page) {
  if (!(await page.locator('.channels').count())) return [];
  const faults = [];
  const node = page.locator('.channels').first();
  const { width, height, channels } = await page.evaluate(async () => {
    const block = JSON.parse(document.getElementById('content').textContent).blocks.find(
      (b) => b.type === 'channels',
    );
    const values = await Promise.all(block.channels.map((c) => unpack(c.data)));
    const at = Math.floor(block.height / 4) * block.width + Math.floor(block.width / 4);
    return { ...block, channels: block.channels.map((c, i) => ({ ...c, data: '', value: values[i][at] })) };
  });
  for (const [index, channel] of channels.entries()) {
    await node.locator('select').selectOption({ index });
    await page.waitForTimeout(100);
    const canvas = node.locator('.channel-stage canvas');
    await canvas.scrollIntoViewIfNeeded();
    const box = await canvas.boundingBox();
    const u = Math.floor(width / 4);
    const v = Math.floor(height / 4);
    await page.mouse.move(box.x + ((u + 0.5) / width) * box.width, box.y + ((v + 0.5) / height) * box.height);
    const text = await node.locator('output').textContent();
    if (!text.startsWith(`pixel (${u}, ${v}): ${channel.name} = ${+channel.value.toPrecision(6)}`))
      faults.push(`channel ${channel.name}: "${text}", expected ${channel.value}`);
    const scaleHidden = await node.locator('.scale').isHidden();
    if (scaleHidden !== (channel.kind === 'ids')) faults.push(`channel ${channel.name}: scale`);
  }
  await node.screenshot({ path: path.join(pictures, 'channels.png') });
  return faults;
}

/** Choosing another state of a room draws its traces. */
async function faultsOfRooms(page) {
  const choices = page.locator('.choice select');
  const faults = [];
  for (let i = 0; i < (await choices.count()); i += 1) {
    const choice = choices.nth(i);
    const last = (await choice.locator('option').count()) - 1;
    await choice.selectOption({ index: last });
    await page.waitForTimeout(300);
    const [found, expected] = await choice.evaluate((node, state) => {
      const rooms = JSON.parse(document.getElementById('content').textContent).blocks.filter(
        (b) => b.type === 'room' && b.states.length > 1,
      );
      const index = [...document.querySelectorAll('.choice select')].indexOf(node);
      const host = node.closest('figure').querySelector('.room');
      const sum = (traces) => traces.flatMap((t) => [...(t.x ?? [])]).reduce((a, b) => a + b, 0);
      return [sum(host.data), sum([...rooms[index].traces, ...rooms[index].states[state].traces])];
    }, last);
    if (found !== expected) faults.push(`room ${i + 1}: state ${last} is not drawn`);
  }
  const rooms = page.locator('.room');
  for (let i = 0; i < (await rooms.count()); i += 1)
    await rooms.nth(i).screenshot({ path: path.join(pictures, `room-${i + 1}.png`) });
  return faults;
}

/** The slider moves the line between two pictures. */
async function faultsOfComparisons(page) {
  const sliders = page.locator('.slid input');
  if (!(await sliders.count())) return [];
  await sliders.first().fill('20');
  const line = await page
    .locator('.comparison')
    .first()
    .evaluate((node) => getComputedStyle(node).getPropertyValue('--line'));
  await page.locator('.slid').first().screenshot({ path: path.join(pictures, 'comparison.png') });
  return line === '20%' ? [] : [`the slider leaves the line at ${line}`];
}

async function check(browser, name, viewport) {
  const faults = [];
  const context = await browser.newContext({
    viewport,
    offline: true,
    reducedMotion: 'reduce',
    hasTouch: name === 'phone',
    deviceScaleFactor: name === 'phone' ? 2 : 1,
  });
  const page = await context.newPage();
  page.on('console', (message) => {
    if (message.type() === 'error') faults.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => faults.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(path.resolve(report)).href);
  await page.locator('body[data-ready]').waitFor({ timeout: 60000 });
  faults.push(...(await page.evaluate(faultsOfPage)));
  await page.screenshot({ path: path.join(pictures, `${name}.png`), fullPage: true });
  if (name === 'desktop') {
    for (const of of [faultsOfViewer, faultsOfTip, faultsOfComparisons, faultsOfChannels, faultsOfRooms])
      faults.push(...(await of(page)));
    await page.pdf({
      path: path.join(pictures, 'print.pdf'),
      format: 'A4',
      printBackground: false,
      preferCSSPageSize: true,
    });
  }
  const found = await page.evaluate(() =>
    ['.plot', '.oval', '.picture', '.comparison', '.channels', '.room', 'table', '.attachment']
      .map(
        (selector) => `${document.querySelectorAll(selector).length} ${selector.replace('.', '')}`,
      )
      .join(', '),
  );
  await context.close();
  return { faults: faults.map((fault) => `${name}: ${fault}`), found };
}

const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'report-page-'));
const browser = await chromium.launch({
  executablePath,
  args: ARGS,
  headless: true,
  env: { ...process.env, HOME: profile },
});
const results = [];
try {
  for (const [name, viewport] of Object.entries(SIZES))
    results.push(await check(browser, name, viewport));
} finally {
  await browser.close();
  fs.rmSync(profile, { recursive: true, force: true });
}
const faults = results.flatMap((result) => result.faults);
console.log(
  faults.length
    ? faults.join('\n')
    : `report_page: whole (${results[0].found}); screenshots in ${pictures}`,
);
process.exit(faults.length ? 1 : 0);
