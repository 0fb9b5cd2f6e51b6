// Headless Chromium driven by the DevTools protocol over a pipe (file descriptors 3 and 4): no port, no package.
// CHROMIUM in the environment names another browser. Whatever ends this process ends the browser.
import { spawn } from 'node:child_process'

const answerLimitMs = 20_000

// The browser as { send(method, params), events: [{ method, params }], close() } attached to one blank page.
export async function openBrowser(profile) {
  const flags = [
    '--headless',
    '--no-sandbox',
    '--disable-gpu',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    '--disable-dev-shm-usage',
    '--hide-scrollbars',
    `--user-data-dir=${profile}`,
    '--remote-debugging-pipe',
    '--window-size=1280,900',
    'about:blank',
  ]
  const child = spawn(process.env.CHROMIUM ?? '/usr/bin/chromium', flags, {
    stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
    detached: true,
  })
  const waiting = new Map()
  const events = []
  const failAll = (error) => waiting.forEach(({ reject }) => reject(error))
  const ended = new Promise((resolve) => child.once('exit', resolve))
  let lost = null
  const lose = (why) => failAll((lost = new Error(`the browser ended: ${why}`)))
  child.once('error', (error) => lose(error.message))
  child.once('exit', (code, signal) => lose(`exit ${code ?? signal}`))
  child.stdio[3].on('error', () => {})
  let rest = Buffer.alloc(0)
  child.stdio[4].on('data', (chunk) => {
    rest = Buffer.concat([rest, chunk])
    for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
      const message = JSON.parse(rest.subarray(0, end).toString())
      rest = rest.subarray(end + 1)
      const call = waiting.get(message.id)
      waiting.delete(message.id)
      if (message.id === undefined) events.push(message)
      else if (message.error) call?.reject(new Error(`${call.method}: ${message.error.message}`))
      else call?.resolve(message.result)
    }
  })
  let lastId = 0
  let sessionId
  const send = (method, params = {}) =>
    new Promise((resolve, reject) => {
      if (lost) return reject(lost)
      const timer = setTimeout(
        () => reject(new Error(`${method}: no answer in ${answerLimitMs / 1000} s`)),
        answerLimitMs,
      )
      const settle = (how) => (value) => {
        clearTimeout(timer)
        how(value)
      }
      waiting.set(++lastId, { method, resolve: settle(resolve), reject: settle(reject) })
      child.stdio[3].write(JSON.stringify({ id: lastId, method, params, sessionId }) + '\0')
    })
  const kill = () => {
    try {
      process.kill(-child.pid, 'SIGKILL')
    } catch {
      /* already gone */
    }
  }
  process.once('exit', kill)
  for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.once(signal, () => process.exit(130))
  const close = async () => {
    sessionId = undefined
    if (!lost) await send('Browser.close').catch(() => {})
    await Promise.race([ended, new Promise((resolve) => setTimeout(resolve, 3000))])
    kill()
  }
  const { targetId } = await send('Target.createTarget', { url: 'about:blank' })
  sessionId = (await send('Target.attachToTarget', { targetId, flatten: true })).sessionId
  for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await send(`${domain}.enable`)
  await send('Emulation.setDeviceMetricsOverride', {
    width: 1280,
    height: 900,
    deviceScaleFactor: 1,
    mobile: false,
  })
  return { send, events, close }
}

// The value of a JavaScript expression in the page; its promise is awaited, its exception thrown.
export async function evaluate(browser, expression) {
  const answer = await browser.send('Runtime.evaluate', {
    expression,
    awaitPromise: true,
    returnByValue: true,
  })
  if (answer.exceptionDetails)
    throw new Error(answer.exceptionDetails.exception?.description ?? answer.exceptionDetails.text)
  return answer.result.value
}
