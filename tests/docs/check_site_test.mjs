// The site check must see what it is there to see: a small hand-made site passes, and each fault planted in a page of a
// second one is named. Run: node tests/docs/check_site_test.mjs   (exit 77: no Chromium on this machine)
import assert from 'node:assert/strict'
import { spawnSync } from 'node:child_process'
import fs from 'node:fs'
import os from 'node:os'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const check = path.join(path.dirname(fileURLToPath(import.meta.url)), '../../docs/check_site.mjs')
if (!fs.existsSync(process.env.CHROMIUM ?? '/usr/bin/chromium')) {
  console.log('skipped: no Chromium (package chromium)')
  process.exit(77)
}

// What the check expects of VitePress: an app that has started, and a search box that answers.
const start = `<script>
  document.querySelector('#app').__vue_app__ = {}
  document.querySelector('.DocSearch-Button').onclick = () => {
    const box = document.body.appendChild(document.createElement('div'))
    box.className = 'VPLocalSearchBox'
    box.innerHTML = '<input>'
    box.firstChild.oninput = () => box.insertAdjacentHTML('beforeend', '<p class="result">hit</p>')
  }
</script>`
const page = (body, { heading = '<h1 id="top">Welkin</h1>', script = start } = {}) =>
  `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>x</title><link rel="icon" href="data:,"></head>
   <body><div id="app"><button class="DocSearch-Button">Search</button>${heading}${body}</div>${script}</body></html>`
const formula = '<mjx-container><svg width="20" height="20"><path d="M0 0h20v20z"/></svg></mjx-container>'
const picture = `<img src="data:image/svg+xml,${encodeURIComponent('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>')}">`

function run(pages, markdown) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'welkin-check-'))
  try {
    for (const [name, text] of Object.entries({ ...pages, '404.html': page('') })) {
      fs.mkdirSync(path.dirname(path.join(folder, 'dist', name)), { recursive: true })
      fs.writeFileSync(path.join(folder, 'dist', name), text)
    }
    fs.mkdirSync(path.join(folder, 'docs'))
    for (const [name, text] of Object.entries(markdown)) fs.writeFileSync(path.join(folder, 'docs', name), text)
    const options = ['--dist', path.join(folder, 'dist'), '--docs', path.join(folder, 'docs'), '--limit', '4']
    return spawnSync(process.execPath, [check, ...options], { encoding: 'utf8', timeout: 120_000 })
  } finally {
    fs.rmSync(folder, { recursive: true, force: true })
  }
}

const index = page(`<p>${formula}${picture}<a href="sub/two.html#there">two</a> <a href="#top">top</a></p>`)
const good = run({ 'index.html': index, 'sub/two.html': page('<p id="there">here</p>') }, { 'index.md': '# Welkin\n\n$x$\n' })
assert.equal(good.status, 0, good.stdout + good.stderr)
assert.match(good.stdout, /^5 passed, 0 failed$/m)

// page -> [its body, what must be said below its FAIL line]
const faults = {
  console: [page(`<script>console.error('planted')</script>`), 'console: planted'],
  exception: [page(`<script>throw new Error('planted')</script>`), 'exception: Error: planted'],
  image: [page('<img src="/none.png">'), 'picture without pixels: /none.png'],
  request: [page('<script src="/none.js"></script>'), '/none.js 404'],
  outside: [page(`<script>fetch('http://127.0.0.1:9/x').catch(() => {})</script>`), 'request leaves this machine: http://127.0.0.1:9/x'],
  heading: [page('<p>text</p>', { heading: '' }), 'no h1'],
  stopped: [page('<p>text</p>', { script: '' }), 'the page script did not start'],
  wide: [page('<div style="width:3000px">x</div>'), 'scrolls sideways by'],
  narrow: [page('<div style="width:600px">x</div>'), 'in a window 390 wide'],
  raw: [page('<p>$x$</p>'), 'its formulas are not rendered'],
  empty: [page('<mjx-container><svg width="0" height="0"></svg></mjx-container>'), '1 formulas without a size'],
  merror: [page(formula.replace('<path', '<g data-mml-node="merror"/><path')), '1 with an error'],
}
const links = '<a href="/gone.html">x</a><a href="#gone">x</a><a href="file:///etc">x</a>'
const pages = Object.fromEntries(Object.entries(faults).map(([name, [text]]) => [`${name}.html`, text]))
const noSearch = page(links, { script: `<script>document.querySelector('#app').__vue_app__ = {}</script>` })
const markdown = { 'raw.md': '# A\n\n$x$\n', 'lost.md': '# Lost\n' }
const bad = run({ ...pages, 'index.html': noSearch }, markdown)
assert.equal(bad.status, 1, bad.stdout + bad.stderr)
const said = bad.stdout.split(/^(?=ok |FAIL |\d+ passed)/m)
const expect = (what, line) => {
  const block = said.find((text) => text.startsWith(`FAIL ${what}`)) ?? ''
  assert.ok(block.includes(line), `'${what}' does not say '${line}':\n${bad.stdout}`)
}
for (const [name, [, line]] of Object.entries(faults)) expect(`${name}.html`, line)
expect('every Markdown page', 'lost.md is not')
expect('links and anchors', 'dead link /gone.html')
expect('links and anchors', 'dead anchor /index.html#gone')
expect('links and anchors', 'link file:///etc')
expect("search for 'Welkin'", 'search box')
assert.match(bad.stdout, new RegExp(`^1 passed, ${Object.keys(faults).length + 3} failed$`, 'm'))

const usage = spawnSync(process.execPath, [check, '--nope', 'x'], { encoding: 'utf8' })
assert.equal(usage.status, 2)
assert.match(usage.stderr, /^unknown or incomplete option --nope: accepted are .*\n$/)
console.log(`the good site passes; ${Object.keys(faults).length + 5} planted faults are named`)
