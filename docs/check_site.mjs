// Opens every page of the built site in headless Chromium and checks what a reader would see: the page arrives, has a
// heading, its script starts, nothing fails or reaches outside this machine, pictures and mathematics have a size,
// the page does not scroll sideways, links and their anchors lead somewhere, and the search finds things.
//
//   node check_site.mjs [--dist DIR] [--docs DIR] [--shots DIR] [--limit SECONDS]
// --shots writes a picture of each page there; --limit is for each wait on a page (20).
//
// Exit 0: all passed, 1: something failed, 2: it could not start. Ends within four minutes whatever happens.
import fs from 'node:fs'
import os from 'node:os'
import path from 'node:path'
import { fileURLToPath } from 'node:url'
import { evaluate, openBrowser } from './.vitepress/chromium.mjs'
import { serve } from './.vitepress/serve.mjs'

const here = path.dirname(fileURLToPath(import.meta.url))
const wholeLimitMs = 240_000
let waitLimitMs = 20_000
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms))

function readArguments() {
  const known = { '--dist': path.join(here, '.vitepress/dist'), '--docs': here, '--shots': '', '--limit': '20' }
  for (let i = 2; i < process.argv.length; i += 2) {
    if (!(process.argv[i] in known) || process.argv[i + 1] === undefined) {
      stop(
        `unknown or incomplete option ${process.argv[i]}: accepted are --dist DIR, --docs DIR, --shots DIR, --limit S`,
      )
    }
    known[process.argv[i]] = process.argv[i + 1]
  }
  if (!(known['--limit'] > 0 && known['--limit'] <= 60)) stop('--limit takes seconds, up to 60')
  waitLimitMs = 1000 * known['--limit']
  if (known['--shots']) fs.mkdirSync(known['--shots'], { recursive: true })
  return { dist: path.resolve(known['--dist']), docs: path.resolve(known['--docs']), shots: known['--shots'] }
}

function stop(message) {
  console.error(message)
  process.exit(2)
}

function filesUnder(folder, extension) {
  const names = fs.readdirSync(folder, { recursive: true }).map((name) => name.split(path.sep).join('/'))
  return names
    .filter((name) => name.endsWith(extension) && !/(^|\/)(node_modules|\.vitepress|generated)\//.test(name))
    .sort()
}

// A formula in the Markdown, outside code.
function hasMathematics(markdown) {
  const prose = markdown
    .replace(/^\s*(```+|~~~+)[\s\S]*?^\s*\1/gm, '')
    .replace(/`[^`\n]*`/g, '')
    .replace(/<!--[\s\S]*?-->/g, '')
  return /\$\$[\s\S]+?\$\$/.test(prose) || /(^|[^\\$])\$(?=[^\s$])[^$\n]*[^\s$\\]\$(?!\d)/m.test(prose)
}

async function until(test, what) {
  for (const end = Date.now() + waitLimitMs; Date.now() < end; await pause(30)) if (await test()) return
  throw new Error(`${what}: not within ${waitLimitMs / 1000} s`)
}

// What the browser reported since `from`: errors on the console, exceptions, failed requests, requests that leave the machine.
function complaints(events, from, origin) {
  const found = []
  const asked = new Map(
    events
      .filter((e) => e.method === 'Network.requestWillBeSent')
      .map((e) => [e.params.requestId, e.params.request.url]),
  )
  for (const { method, params } of events.slice(from)) {
    if (method === 'Runtime.exceptionThrown')
      found.push(
        `exception: ${params.exceptionDetails.exception?.description ?? params.exceptionDetails.text}`,
      )
    if (method === 'Runtime.consoleAPICalled' && ['error', 'assert'].includes(params.type))
      found.push(`console: ${params.args.map((a) => a.value ?? a.description).join(' ')}`)
    if (method === 'Log.entryAdded' && params.entry.level === 'error')
      found.push(`log: ${params.entry.text} ${params.entry.url ?? ''}`)
    if (method === 'Network.loadingFailed' && !params.canceled)
      found.push(`request failed: ${asked.get(params.requestId)} ${params.errorText}`)
    if (method === 'Network.responseReceived' && params.response.status >= 400)
      found.push(`request failed: ${params.response.url} ${params.response.status}`)
    if (
      method === 'Network.requestWillBeSent' &&
      !params.request.url.startsWith(origin + '/') &&
      !/^(data|blob):/.test(params.request.url)
    ) {
      found.push(`request leaves this machine: ${params.request.url}`)
    }
  }
  return [...new Set(found)].map((line) => line.split('\n')[0])
}

// Runs in the page: what a reader would see.
const look = `(async () => {
  const images = [...document.images]
  for (const image of images) image.loading = 'eager'
  await Promise.all(images.map((image) => image.decode().catch(() => {})))
  const boxed = (element) => { const box = element.getBoundingClientRect(); return box.width > 1 && box.height > 1 }
  const formulas = [...document.querySelectorAll('mjx-container')]
  return {
    heading: document.querySelector('h1')?.textContent.trim() ?? '',
    deadImages: images.filter((image) => image.naturalWidth === 0).map((image) => image.getAttribute('src')),
    formulas: formulas.length,
    emptyFormulas: formulas.filter((f) => !(f.querySelector('svg') && boxed(f.querySelector('svg')))).length,
    badFormulas: document.querySelectorAll('mjx-container [data-mml-node="merror"], mjx-container [data-mjx-error]').length,
    ids: [...document.querySelectorAll('[id]')].map((element) => element.id),
    links: [...document.querySelectorAll('a[href]')].map((a) => a.href),
  }
})()`

async function visit(browser, origin, page, shot) {
  const from = browser.events.length
  const fails = []
  const went = await browser.send('Page.navigate', { url: `${origin}/${page}` })
  if (went.errorText) return { ids: [], links: [], formulas: 0, fails: [went.errorText] }
  await until(() => browser.events.slice(from).some((e) => e.method === 'Page.loadEventFired'), 'load')
  const answer = browser.events
    .slice(from)
    .find((e) => e.method === 'Network.responseReceived' && e.params.type === 'Document')
  if (answer?.params.response.status !== 200) fails.push(`answered ${answer?.params.response.status}`)
  await until(
    () => evaluate(browser, `Boolean(document.querySelector('#app')?.__vue_app__)`),
    'the page script did not start',
  )
  const seen = await evaluate(browser, look)
  for (const width of [390, 1280]) {
    await browser.send('Emulation.setDeviceMetricsOverride', {
      width,
      height: 900,
      deviceScaleFactor: 1,
      mobile: false,
    })
    const beyond = await evaluate(browser, 'document.documentElement.scrollWidth - window.innerWidth')
    if (beyond > 0) fails.push(`scrolls sideways by ${beyond} pixels in a window ${width} wide`)
  }
  if (!seen.heading) fails.push('no h1')
  if (seen.deadImages.length) fails.push(`picture without pixels: ${seen.deadImages.join(', ')}`)
  if (seen.emptyFormulas || seen.badFormulas)
    fails.push(`${seen.emptyFormulas} formulas without a size, ${seen.badFormulas} with an error`)
  fails.push(...complaints(browser.events, from, origin))
  if (shot) {
    const picture = await browser.send('Page.captureScreenshot', {
      format: 'png',
      captureBeyondViewport: true,
    })
    fs.writeFileSync(shot, Buffer.from(picture.data, 'base64'))
  }
  return { ...seen, fails }
}

function deadLinks(pages, origin, dist) {
  const found = []
  for (const [page, { links }] of pages) {
    for (const link of new Set(links)) {
      const url = new URL(link)
      if (url.origin !== origin) {
        if (!/^(https?|mailto):$/.test(url.protocol)) found.push(`${page}: link ${link}`)
        continue
      }
      const name = decodeURIComponent(url.pathname).slice(1)
      const target = [name, `${name}.html`, `${name}index.html`].find((candidate) => pages.has(candidate))
      const anchor = decodeURIComponent(url.hash.slice(1))
      if (target === undefined && !(name && fs.existsSync(path.join(dist, name))))
        found.push(`${page}: dead link /${name}`)
      if (target !== undefined && anchor && !pages.get(target).ids.includes(anchor))
        found.push(`${page}: dead anchor /${name}#${anchor}`)
    }
  }
  return found
}

// Types a word from the first page's heading into the search box and waits for a hit.
async function search(browser, origin, word) {
  const from = browser.events.length
  await browser.send('Page.navigate', { url: `${origin}/` })
  await until(
    () =>
      evaluate(
        browser,
        `Boolean(document.querySelector('#app')?.__vue_app__ && document.querySelector('.DocSearch-Button, #local-search button'))`,
      ),
    'search button',
  )
  await evaluate(browser, `document.querySelector('.DocSearch-Button, #local-search button').click()`)
  await until(
    () => evaluate(browser, `Boolean(document.querySelector('.VPLocalSearchBox input'))`),
    'search box',
  )
  await evaluate(browser, `document.querySelector('.VPLocalSearchBox input').focus()`)
  await browser.send('Input.insertText', { text: word })
  await until(
    () => evaluate(browser, `document.querySelectorAll('.VPLocalSearchBox .result').length > 0`),
    `search for '${word}' finds nothing`,
  )
  return complaints(browser.events, from, origin)
}

async function main() {
  const { dist, docs, shots } = readArguments()
  if (!fs.existsSync(path.join(dist, 'index.html'))) stop('the site is not built: run npm run build first')
  const names = filesUnder(dist, '.html').filter((name) => name !== '404.html')
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'welkin-site-'))
  process.once('exit', () => fs.rmSync(profile, { recursive: true, force: true, maxRetries: 5 }))
  const server = await serve(dist, 0)
  const origin = `http://127.0.0.1:${server.address().port}`
  const pages = new Map()
  let passed = 0
  let failed = 0
  const report = (what, fails) => {
    if (fails.length) failed++
    else passed++
    console.log(
      fails.length ? [`FAIL ${what}`, ...fails.map((fail) => `     ${fail}`)].join('\n') : `ok   ${what}`,
    )
  }
  const browser = await openBrowser(profile).catch((error) =>
    stop(`cannot start Chromium (package chromium, or CHROMIUM=path): ${error.message}`),
  )
  const watchdog = setTimeout(() => {
    console.log(`FAIL not finished in ${wholeLimitMs / 1000} s: ${passed} passed, ${failed + 1} failed`)
    process.exit(1)
  }, wholeLimitMs)
  try {
    for (const name of names) {
      const source = path.join(docs, name.replace(/\.html$/, '.md'))
      const shot = shots && path.join(shots, name.replace(/\//g, '_').replace(/html$/, 'png'))
      const seen = await visit(browser, origin, name, shot).catch((error) => ({
        ids: [],
        links: [],
        formulas: 0,
        fails: [error.message],
      }))
      if (fs.existsSync(source) && hasMathematics(fs.readFileSync(source, 'utf8')) && seen.formulas === 0)
        seen.fails.push('its formulas are not rendered')
      pages.set(name, seen)
      report(`${name}${seen.formulas ? ` (${seen.formulas} formulas)` : ''}`, seen.fails)
    }
    const missing = filesUnder(docs, '.md').filter((name) => !pages.has(name.replace(/md$/, 'html')))
    report(
      'every Markdown page is on the site',
      missing.map((name) => `${name} is not`),
    )
    report('links and anchors', deadLinks(pages, origin, dist))
    const word = pages.get('index.html')?.heading?.match(/\p{L}{4,}/u)?.[0] ?? 'index'
    report(`search for '${word}'`, await search(browser, origin, word).catch((error) => [error.message]))
  } finally {
    clearTimeout(watchdog)
    await browser.close()
    server.closeAllConnections()
    server.close()
  }
  console.log(`${passed} passed, ${failed} failed`)
  process.exitCode = failed ? 1 : 0
}

await main()
