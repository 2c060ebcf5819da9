// What every report says of its run: the conditions in its head, and the machine.
'use strict';

function drawConditions() {
  show('conditions', ...DATA.conditions.map(item => element('div', {}, element('dt', {}, item.label), element('dd', {}, item.value))));
}

function drawMachine() {
  const machine = DATA.machine;
  const loops = machine.axes.length ? `; fast loop ${machine.fast_period_us} µs, position loop ${machine.slow_period_ms} ms` : '';
  document.getElementById('machine-name').textContent = `${machine.name} (${machine.id})${loops}`;
  show('machine', ...machine.sections.map(section =>
    table([[text(section.title, { class: 'text title' }), ...section.columns.map(column => text(column)), text('', { class: 'unit' })]],
          section.rows.map(row => [{ text: symbolText(row.label), head: true }, ...machineCells(row.values), text(row.unit, { class: 'unit' })]))));
}

// Words that hold for every axis stand once, across the axes.
function machineCells(values) {
  const words = values.every(value => value === values[0] && /^[^\d−]|[a-z]/.test(value));
  return words && values.length > 1 ? [text(values[0], { span: values.length })] : values.map(value => text(value || '–'));
}
