// The page of a fleet: a table of axes with the course of each parameter as a small chart.
'use strict';

const WIDTH = 190, HEIGHT = 64, MARGIN = 4;
const minus = number => number.replace('-', '−');

// What a column shows: the largest deviation from the mean that any estimate, trend or interval has, relative.
function reachOf(cause) {
  let reach = 0.01;
  for (const axis of DATA.axes) {
    const course = axis.courses[cause];
    const middle = course.trend ? course.trend.mean : course.values[0];
    course.values.forEach((value, k) => { reach = Math.max(reach, (Math.abs(value - middle) + course.halves[k]) / course.scale); });
  }
  return reach;
}

function smallChart(course, reach) {
  if (!course.values.length) return '–';
  const middle = course.trend ? course.trend.mean : course.values[0];
  const x = month => MARGIN + month / Math.max(DATA.months, 1e-9) * (WIDTH - 2 * MARGIN);
  const y = value => HEIGHT / 2 - (value - middle) / course.scale / reach * (HEIGHT / 2 - MARGIN);
  const picture = svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: 'img' });
  picture.append(svg('path', { d: `M0 ${HEIGHT / 2}H${WIDTH}`, style: `stroke:${GRID}` }));
  if (course.trend) {
    const first = course.months[0], last = course.months[course.months.length - 1];
    const line = month => course.trend.mean + course.trend.slope * (month - course.trend.month);
    const half = month => Math.hypot(course.trend.mean_half, course.trend.half * (month - course.trend.month));
    const steps = Array.from({ length: 13 }, (_, k) => first + (last - first) * k / 12);
    const upper = steps.map(month => `${x(month).toFixed(1)} ${y(line(month) + half(month)).toFixed(1)}`);
    const lower = steps.map(month => `${x(month).toFixed(1)} ${y(line(month) - half(month)).toFixed(1)}`).reverse();
    picture.append(svg('path', { d: `M${[...upper, ...lower].join('L')}z`, style: 'fill:var(--band)' }),
                   svg('path', { d: `M${x(first)} ${y(line(first))}L${x(last)} ${y(line(last))}`, style: `stroke:${INK};fill:none` }));
  }
  course.values.forEach((value, k) => {
    const at = x(course.months[k]);
    picture.append(svg('path', { d: `M${at} ${y(value - course.halves[k])}V${y(value + course.halves[k])}`, style: 'stroke:var(--blue)' }),
                   svg('circle', { cx: at, cy: y(value), r: 1.8, style: 'fill:var(--blue)' }));
  });
  if (course.alarm) {
    const at = x(course.alarm.month), side = course.alarm.direction > 0 ? 1 : -1, tip = side > 0 ? 1 : HEIGHT - 1;
    picture.append(svg('path', { d: `M${x(course.alarm.since)} 0V${HEIGHT}`, style: 'stroke:var(--differs);stroke-dasharray:1 3' }),
                   svg('path', { d: `M${at} ${tip}l4 ${8 * side}h-8z`, style: 'fill:var(--differs)' }));
  }
  return picture;
}

function trendText(course) {
  if (!course.trend) return 'no trend yet';
  const share = value => (100 * value / course.scale).toFixed(2);
  const slope = course.trend.slope >= 0 ? `+${share(course.trend.slope)}` : minus(share(course.trend.slope));
  return `${slope} ± ${share(course.trend.half)} % a month`;
}

function drawAxes() {
  const reaches = DATA.causes.map((_, c) => reachOf(c));
  const head = [text('Axis', { class: 'text' }), text('Machine', { class: 'text' }), text('Records'),
                ...DATA.causes.map((cause, c) => text(`${cause.words}, ± ${(100 * reaches[c]).toPrecision(2)} %`, { class: 'text' }))];
  const body = DATA.axes.map(axis => [
    { text: axis.axis, head: true, class: 'text' }, text(axis.machine, { class: 'text' }), text(String(axis.records)),
    ...axis.courses.map((course, c) => text([element('div', {}, smallChart(course, reaches[c])), trendText(course)],
                                            { class: course.alarm ? 'text differs' : 'text' }))]);
  show('axes', table([head], body));
  document.getElementById('axes-what').textContent =
    `months from ${DATA.first}, height of a chart in % of the parameter, trend with its 95 % interval; at most ${DATA.false_alarms} false alarms are expected of an axis in a year`;
}

function drawScatter() {
  const drawn = table([[text('Parameter', { class: 'text' }), text('Scatter in %')]],
                      DATA.causes.map(cause => [text(cause.words, { class: 'text' }), text((100 * cause.between).toFixed(2), { class: 'value' })]));
  drawn.className = 'bare';
  show('scatter', drawn);
}

function drawBroken() {
  if (!DATA.broken.length) return document.getElementById('broken-section').remove();
  show('broken', table([[text('Axis', { class: 'text' }), text('Date', { class: 'text' }), text('Message', { class: 'text' })]],
                       DATA.broken.map(each => [text(each.axis, { class: 'text' }), text(each.date, { class: 'text' }),
                                                text(each.message, { class: 'text wrap' })])));
}

// A fleet has many machines, whose files the head names.
document.querySelector('.sheet-of-machine')?.parentElement.remove();
drawAxes();
drawScatter();
drawBroken();
drawSchemeSwitch();
