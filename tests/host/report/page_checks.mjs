// What every report must be for its reader, whatever it shows, as functions that run in the page and return sentences
// on what is wrong: axes with units, contrast, nothing cut off on a narrow screen and on paper. opened_page.mjs calls
// them.

// Every axis that is drawn has a title with a unit ("coherence, 1" for a number); a chart whose abscissa is drawn by
// the one below has no words there.
export function axesWithoutUnit() {
  const wrong = [];
  for (const chart of document.querySelectorAll('.js-plotly-plot'))
    for (const [name, axis] of Object.entries(chart._fullLayout)) {
      if (!/^[xy]axis\d*$/.test(name) || axis.visible === false) continue;
      const words = (axis.title?.text || '').replaceAll('<br>', ' ');
      if (words === '' && axis.showticklabels === false) continue;
      if (!/, \S+/.test(words)) wrong.push(`${name} of chart '${chart.id}' has the title '${words}', without a unit`);
    }
  return wrong;
}

// Texts have a contrast of 4.5 on their background, series, axes and legend marks 3 (WCAG 2.1, AA). What is switched off is
// exempt.
export function poorContrasts() {
  const TEXT = 4.5, GRAPHICS = 3;
  const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const parsed = new Map();
  const rgba = colour => {
    if (!parsed.has(colour)) {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = colour;
      canvas.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
      parsed.set(colour, [r, g, b, a / 255]);
    }
    return parsed.get(colour);
  };
  const over = ([r, g, b, a], under) => [r, g, b].map((each, i) => each * a + under[i] * (1 - a));
  const luminance = rgb => rgb.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const ratio = (one, other) => {
    const [high, low] = [luminance(one), luminance(other)].sort((a, b) => b - a);
    return (high + 0.05) / (low + 0.05);
  };
  const behind = node => {
    const layers = [];
    for (let at = node; at; at = at.parentElement) {
      const colour = rgba(getComputedStyle(at).backgroundColor);
      if (colour[3] > 0) layers.push(colour);
      if (colour[3] === 1) break;
    }
    return layers.reverse().reduce((under, layer) => over(layer, under), [255, 255, 255]);
  };
  const wrong = new Set();
  const judge = (what, colour, under, wanted) => {
    const found = ratio(over(rgba(colour), under), under);
    if (found < wanted - 0.005) wrong.add(`${what} has a contrast of ${found.toFixed(2)}, wanted ${wanted}`);
  };
  const ownText = node => [...node.childNodes].some(child => child.nodeType === Node.TEXT_NODE && child.textContent.trim());
  for (const node of document.querySelectorAll('body *')) {
    if (!ownText(node) || ['SCRIPT', 'STYLE', 'NOSCRIPT'].includes(node.tagName) || !node.checkVisibility?.({ visibilityProperty: true })) continue;
    if (node.closest('label:has(:disabled)')) continue;
    const style = getComputedStyle(node), inChart = node.closest('svg.main-svg');
    judge(`text '${node.textContent.trim().slice(0, 40)}'`, inChart ? style.fill : style.color, behind(node), TEXT);
  }
  for (const node of document.querySelectorAll('.swatch, .dot')) {
    const style = getComputedStyle(node), colour = style.backgroundImage === 'none' ? style.borderTopStyle === 'solid' ? style.borderTopColor : style.backgroundColor
      : style.backgroundImage.match(/rgba?\([^)]*\)/)[0];
    if (!node.closest('label:not(:has(:checked))')) judge('a mark of the legend', colour, behind(node.parentElement), GRAPHICS);
  }
  for (const chart of document.querySelectorAll('.js-plotly-plot')) {
    const under = over(rgba(chart._fullLayout.plot_bgcolor), behind(chart));
    for (const trace of chart._fullData) {
      if (trace.hoverinfo === 'skip') continue;  // the band of a curve, which has a line in it
      for (const colour of [trace.mode?.includes('lines') && trace.line?.color, (trace.type === 'bar' || trace.mode?.includes('markers')) && trace.marker?.color])
        if (colour) judge(`series '${trace.name}' of chart '${chart.id}'`, colour, under, GRAPHICS);
    }
    for (const [name, axis] of Object.entries(chart._fullLayout))
      if (/^[xy]axis\d*$/.test(name) && axis.linecolor) judge(`${name} of chart '${chart.id}'`, axis.linecolor, under, GRAPHICS);
  }
  return [...wrong];
}

// Series of one chart differ by colour, for normal and for colour-blind eyes, or by dash or symbol. The least distance is
// that of Oklab; 0.06 is about three times what is just noticed for lines. Simulated eyes: Machado et al. 2009.
export function confusableSeries() {
  const LEAST = 0.06;
  const EYES = { normal: [1, 0, 0, 0, 1, 0, 0, 0, 1],
                 'without red receptors': [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
                 'without green receptors': [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881] };
  const canvas = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const linear = colour => {
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data].slice(0, 3).map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  };
  const seen = (m, v) => [0, 3, 6].map(i => Math.max(0, m[i] * v[0] + m[i + 1] * v[1] + m[i + 2] * v[2]));
  const oklab = ([r, g, b]) => {
    const [l, m, s] = [0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b, 0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b,
                       0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b].map(Math.cbrt);
    return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
  };
  const look = trace => trace.type === 'bar' ? 'bar' : trace.mode.includes('lines') ? `line ${trace.line.dash}` : `points ${trace.marker.symbol}`;
  const wrong = new Set();
  for (const chart of document.querySelectorAll('.js-plotly-plot')) {
    const traces = chart._fullData.filter(trace => trace.hoverinfo !== 'skip');
    traces.forEach((one, i) => traces.slice(0, i).forEach(other => {
      if (one.name === other.name || one.xaxis !== other.xaxis || one.yaxis !== other.yaxis || look(one) !== look(other)) return;
      const [a, b] = [one, other].map(trace => linear(trace.mode?.includes('lines') ? trace.line.color : trace.marker.color));
      for (const [eyes, matrix] of Object.entries(EYES)) {
        const [p, q] = [a, b].map(v => oklab(seen(matrix, v))), distance = Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        if (distance < LEAST) wrong.add(`'${one.name}' and '${other.name}' of chart '${chart.id}' look alike to eyes ${eyes} (${distance.toFixed(3)})`);
      }
    }));
  }
  return [...wrong];
}

// Nothing is wider than the page, no text is cut off, and the words of a chart lie within it. `framed`: a table may be
// moved within its own frame, as on a narrow screen.
export function cutOff(framed) {
  const wrong = new Set(), width = document.documentElement.clientWidth, SLACK = 1.5;  // pixels
  if (document.documentElement.scrollWidth > width) wrong.add(`the page is ${document.documentElement.scrollWidth - width} pixels wider than the window`);
  for (const node of document.querySelectorAll('body *:not(script, style, noscript)')) {
    if (!node.checkVisibility?.({ visibilityProperty: true })) continue;
    const frame = node.closest('.scroll'), style = getComputedStyle(node);
    const words = `${node.tagName.toLowerCase()}${node.id ? `#${node.id}` : ''}${typeof node.className === 'string' && node.className ? `.${node.className}` : ''} '${(node.textContent || '').trim().slice(0, 40)}'`;
    if (!framed && frame === node && node.scrollWidth > node.clientWidth + SLACK) wrong.add(`${words} is ${node.scrollWidth - node.clientWidth} pixels wider than its frame`);
    if (node.closest('svg')) continue;
    if (!frame && node.getBoundingClientRect().right > width + SLACK) wrong.add(`${words} ends beyond the page`);
    if (style.display !== 'inline' && ['hidden', 'clip'].includes(style.overflowX) && node.scrollWidth > node.clientWidth + SLACK) wrong.add(`${words} is cut off`);
  }
  for (const chart of document.querySelectorAll('.js-plotly-plot')) {
    const box = chart.getBoundingClientRect(), svg = chart.querySelector('.main-svg').getBoundingClientRect();
    if (svg.right > box.right + SLACK || svg.bottom > box.bottom + SLACK) wrong.add(`chart '${chart.id}' is drawn larger than its place`);
    for (const text of chart.querySelectorAll('.main-svg text')) {
      const at = text.getBoundingClientRect();
      if (!text.textContent.trim() || !at.width || at.left >= box.left - SLACK && at.right <= box.right + SLACK && at.top >= box.top - SLACK && at.bottom <= box.bottom + SLACK) continue;
      wrong.add(`'${text.textContent}' of chart '${chart.id}' is cut off`);
    }
  }
  return [...wrong];
}
