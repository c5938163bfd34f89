// SPDX-License-Identifier: BSD-3-Clause
// Effective configuration; what differs from the shipped one is marked.

function configTable(rows) {
  const element = table(
      null, [{title: 'key'}, {title: 'value'}, {title: 'as shipped'}],
      rows.map(
          (row) =>
              [row.key, row.value === '' ? '(empty)' : row.value,
               row.shipped === undefined ? '' :
                   row.shipped === ''    ? '(empty)' :
                                           row.shipped]),
      {'aria-label': `Keys of ${rows[0].section}`});
  element.querySelectorAll('tbody tr').forEach((tr, i) => {
    if (rows[i].shipped === undefined) return;
    tr.classList.add('changed');
    tr.firstChild.append(h('span', {class: 'hidden-text'}, ' (differs from the shipped value)'));
  });
  return element;
}

function configSection(run) {
  const names = [...new Set(run.config.map((row) => row.section))],
        changed = run.config.filter((row) => row.shipped !== undefined);
  const box = h('div', {class: `card pad config long${changed.length ? '' : ' same'}`}, names.map((name) => {
    const rows = run.config.filter((row) => row.section === name),
          differ = rows.filter((row) => row.shipped !== undefined).length;
    return h(
        'details', {open: differ > 0, class: differ ? 'printed' : 'same'},
        h('summary', {}, h('span', {class: 'mono'}, `[${name}]`),
          h('span', {class: differ ? 'tag hot' : 'tag'},
            differ ? `${differ} of ${rows.length} changed` : rows.length)),
        configTable(rows));
  }));
  const toggle =
      h('button', {
        type: 'button',
        class: 'quiet',
        'aria-pressed': 'false',
        onclick: () => {
          toggle.setAttribute('aria-pressed', String(box.classList.toggle('only-changed')));
        }
      },
        'Only what differs');
  if (changed.length) toggle.click();
  const lead = run.config.length ?
      `${whole(run.config.length)} keys; ${
          changed.length ? `${changed.length} differ` : 'none differs'} from the shipped configuration.` :
                           null;
  return section(
      'config', 'Configuration', lead,
      run.config.length ?
          [
            changed.length ? h('div', {class: 'switches', style: 'margin-bottom: .8rem'}, toggle) : null, box
          ] :
          missingNote(run, ['config.ini']),
      run.command ? h('details', {class: 'printed', style: 'margin-top: 1rem'}, h('summary', {}, 'Command of the run'),
                      h('p', {class: 'mono'}, run.command)) :
                    null);
}
