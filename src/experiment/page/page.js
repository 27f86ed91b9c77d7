'use strict';
// Plots over a shared axis that zoom together, tables that sort and are copied. Without this the page stays readable.
document.documentElement.classList.add('js');

const groups = new Map();  // plots by the label of their x axis: those of one quantity zoom together

function follow(plot, group) {
  let busy = false;
  return (g, initial) => {
    if (initial || busy) return;
    const range = g.isZoomed('x') ? g.xAxisRange() : null;
    busy = true;
    for (const other of group) {
      if (other === g) continue;
      const same = JSON.stringify(other.isZoomed('x') ? other.xAxisRange() : null) === JSON.stringify(range);
      if (!same) other.updateOptions({ dateWindow: range });
    }
    busy = false;
  };
}

function draw(script) {
  const figure = script.parentElement;
  const data = JSON.parse(script.textContent);
  const plot = document.createElement('div');
  plot.className = 'plot';
  plot.innerHTML = '<h3></h3><div class="graph"></div><div class="key"></div>';
  plot.querySelector('h3').textContent = data.title;
  figure.insertBefore(plot, script);
  const group = groups.get(data.x) || groups.set(data.x, []).get(data.x);
  const values = new Map();
  const key = plot.querySelector('.key');
  const series = {};  // colours that come again are dashed
  data.labels.forEach((name, k) => { if (data.colors.indexOf(data.colors[k]) < k) series[name] = { strokePattern: [7, 3] }; });
  const graph = new Dygraph(plot.querySelector('.graph'), data.rows, {
    labels: [data.x, ...data.labels], colors: data.colors, series, xlabel: data.x, ylabel: data.y, legend: 'never',
    axes: { y: { axisLabelWidth: 64, axisLabelFormatter: v => String(Number(v.toPrecision(3))) } }, strokeWidth: 1.2, animatedZooms: false, connectSeparatedPoints: true, axisLabelFontSize: 12,
    drawCallback: follow(plot, group),
    highlightCallback: (e, x, points) => {
      for (const p of points) values.get(p.name).textContent = ' ' + Number(p.yval).toPrecision(4) + ' at ' + Number(x).toPrecision(6);
    },
    unhighlightCallback: () => values.forEach(v => { v.textContent = ''; })
  });
  data.labels.forEach((name, k) => {
    const label = document.createElement('label');
    const box = document.createElement('input');
    box.type = 'checkbox';
    box.checked = true;
    box.onchange = () => graph.setVisibility(k, box.checked);
    const text = document.createElement('span');
    text.textContent = name;
    text.style.color = data.colors[k];
    const value = document.createElement('output');
    values.set(name, value);
    label.append(box, text, value);
    key.append(label);
  });
  const whole = document.createElement('button');
  whole.textContent = 'whole range';
  whole.title = 'drag to zoom, shift and drag to pan, double click for the whole range';
  whole.onclick = () => graph.resetZoom();
  key.append(whole);
  group.push(graph);
  figure.classList.add('drawn');
}

// The first number of a cell, in the unit without its prefix: 35.8 mN is less than 0.389 N.
const prefixes = { 'n': 1e-9, 'µ': 1e-6, 'm': 1e-3, 'k': 1e3 };
const number = text => {
  const match = /([-+−]?\d[\d.]*(?:e[-+]?\d+)?)(?:\s*([nµmk])(?=[A-Za-z]))?/i.exec(text);
  return match ? Number(match[1].replace('−', '-')) * (prefixes[match[2]] || 1) : NaN;
};

// Some browsers give pages from files no clipboard; then a selection is copied.
async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch (e) {
    const area = document.createElement('textarea');
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}

function sortable(table) {
  const body = table.tBodies[0];
  Array.from(table.tHead.rows[0].cells).forEach((cell, k) => {
    cell.setAttribute('aria-sort', 'none');
    cell.tabIndex = 0;
    const sort = () => {
      const up = cell.getAttribute('aria-sort') !== 'ascending';
      const text = row => (row.cells[k] ? row.cells[k].textContent : '');
      const rows = Array.from(body.rows).sort((a, b) => {
        const p = number(text(a)), q = number(text(b));
        const order = isNaN(p) || isNaN(q) ? text(a).localeCompare(text(b)) : p - q;
        return up ? order : -order;
      });
      for (const other of table.tHead.rows[0].cells) other.setAttribute('aria-sort', 'none');
      cell.setAttribute('aria-sort', up ? 'ascending' : 'descending');
      body.append(...rows);
    };
    cell.onclick = sort;
    cell.onkeydown = e => { if (e.key === 'Enter') sort(); };
  });
  const copy = document.createElement('button');
  copy.textContent = 'copy as CSV';
  copy.onclick = async () => {
    const quoted = cell => '"' + cell.textContent.replace(/"/g, '""') + '"';
    const text = Array.from(table.rows, row => Array.from(row.cells, quoted).join(',')).join('\n');
    copy.textContent = await copied(text) ? 'copied' : 'the browser does not allow it';
  };
  table.parentElement.after(copy);
}

for (const script of document.querySelectorAll('script.data')) draw(script);
for (const table of document.querySelectorAll('table')) if (table.tHead && table.tBodies[0]) sortable(table);
