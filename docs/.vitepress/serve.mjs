// Serves the built site on loopback only (VitePress' own preview listens on every interface).
// As a program: node .vitepress/serve.mjs [PORT]   (default 4173; 0 = any free port)
import fs from 'node:fs'
import http from 'node:http'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const types = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
  '.webp': 'image/webp',
  '.gif': 'image/gif',
  '.woff2': 'font/woff2',
}

// Resolves to a listening http.Server of the files under `folder`; a page that is missing is 404.html with status 404.
export function serve(folder, port) {
  const server = http.createServer((request, response) => {
    let name = '/'
    try {
      name = path.posix.normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname))
    } catch {
      name = '/404.html'
    }
    const wanted = path.join(folder, name)
    const tried = [wanted, `${wanted}.html`, path.join(wanted, 'index.html')]
    const file = tried.find((candidate) => fs.statSync(candidate, { throwIfNoEntry: false })?.isFile())
    const sent = file ?? path.join(folder, '404.html')
    if (!fs.existsSync(sent)) return response.writeHead(404).end()
    response.writeHead(file ? 200 : 404, {
      'Content-Type': types[path.extname(sent)] ?? 'application/octet-stream',
    })
    fs.createReadStream(sent).pipe(response)
  })
  return new Promise((resolve, reject) => {
    server.once('error', reject)
    server.listen(port, '127.0.0.1', () => resolve(server))
  })
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), 'dist')
  const port = Number(process.argv[2] ?? 4173)
  if (!fs.existsSync(path.join(folder, 'index.html'))) {
    console.error('the site is not built: run npm run build first')
    process.exit(2)
  }
  try {
    const server = await serve(folder, port)
    console.log(`The book: http://127.0.0.1:${server.address().port}/   (Ctrl+C ends)`)
  } catch (error) {
    console.error(
      error.code === 'EADDRINUSE' ? `port ${port} is taken: npm run preview -- PORT` : error.message,
    )
    process.exit(2)
  }
}
