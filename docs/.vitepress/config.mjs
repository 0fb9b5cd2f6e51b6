// The site made from the book's Markdown. The sidebar is read from the pages themselves, so a new chapter needs no change
// here. Nothing is fetched when a page is viewed: system fonts, mathematics turned into SVG by the build, local search.
import fs from 'node:fs'
import path from 'node:path'
import { fileURLToPath } from 'node:url'

const docs = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..')
const parts = [
  [3, 'Part I: first light'],
  [15, 'Part II: the clear sky'],
  [22, 'Part III: clouds from noise'],
  [27, 'Part IV: clouds from data'],
  [31, 'Part V: a place'],
]
const generalPages = ['reading_order', 'command_line', 'scenes', 'accuracy', 'hard_cases', 'glossary']

function pageTitle(file) {
  const heading = /^# +(.+)$/m.exec(fs.readFileSync(path.join(docs, file), 'utf8'))
  return heading ? heading[1].replace(/[`*]/g, '').trim() : path.basename(file, '.md')
}

function sidebar() {
  const folder = path.join(docs, 'chapters')
  const files = fs.existsSync(folder)
    ? fs
        .readdirSync(folder)
        .filter((name) => /^\d\d_\w+\.md$/.test(name))
        .sort()
    : []
  let first = 1
  const groups = parts.map(([last, text]) => {
    const inPart = files.filter(
      (name) => Number(name.slice(0, 2)) >= first && Number(name.slice(0, 2)) <= last,
    )
    first = last + 1
    return {
      text,
      items: inPart.map((name) => ({
        text: pageTitle(`chapters/${name}`),
        link: `/chapters/${name.slice(0, -3)}`,
      })),
    }
  })
  const general = generalPages.filter((name) => fs.existsSync(path.join(docs, `${name}.md`)))
  return [
    { text: 'The book', items: general.map((name) => ({ text: pageTitle(`${name}.md`), link: `/${name}` })) },
    ...groups.filter((group) => group.items.length > 0),
  ]
}

// The anchors that GitHub makes, so that a link to a heading works in the Markdown and on the site (weave.py knows the same rule).
function slugify(heading) {
  return heading
    .toLowerCase()
    .replace(/[^\p{L}\p{M}\p{N}_\- ]/gu, '')
    .replace(/ /g, '-')
}

// Links to sources and data work where the repository is at hand; the site shows them as plain code text.
function sourceLinks(md) {
  md.core.ruler.push('source_links', (state) => {
    const page = path.dirname(path.join(docs, state.env.relativePath ?? 'index.md'))
    for (const block of state.tokens) {
      let inSource = false
      for (const token of block.children ?? []) {
        if (token.type === 'link_open') {
          const target = decodeURI(token.attrGet('href') ?? '').replace(/[#?].*$/, '')
          if (target === '' || /^[a-z]+:/i.test(target)) continue
          const inside = path.resolve(page, target).startsWith(docs + path.sep)
          if (inside && /\.(md|html)$/.test(target)) continue
          Object.assign(token, {
            type: 'html_inline',
            content: '<span class="source">',
            tag: '',
            attrs: null,
            nesting: 0,
          })
          inSource = true
        } else if (token.type === 'link_close' && inSource) {
          Object.assign(token, { type: 'html_inline', content: '</span>', tag: '', nesting: 0 })
          inSource = false
        }
      }
    }
  })
}

// A paragraph that is wholly in emphasis is a caption: where a listing stands, what a table was measured on.
function captions(md) {
  md.core.ruler.push('captions', (state) => {
    state.tokens.forEach((token, i) => {
      const parts = token.type === 'inline' ? token.children : []
      const whole =
        parts[0]?.type === 'em_open' &&
        parts.findIndex((part) => part.type === 'em_close') === parts.length - 1
      if (whole && state.tokens[i - 1].type === 'paragraph_open')
        state.tokens[i - 1].attrJoin('class', 'caption')
    })
  })
}

// A table may be wider than the column: it scrolls by itself, the page does not.
function wideTables(md) {
  md.renderer.rules.table_open = () => '<div class="wide"><table tabindex="0">\n'
  md.renderer.rules.table_close = () => '</table></div>\n'
}

export default {
  lang: 'en',
  title: 'Welkin',
  description: 'Rendering real skies and clouds in real time, one runnable step at a time',
  head: [['link', { rel: 'icon', type: 'image/svg+xml', href: '/welkin.svg' }]],
  srcExclude: ['generated/**', 'node_modules/**'],
  ignoreDeadLinks: false,
  markdown: {
    math: true,
    anchor: { slugify },
    config(md) {
      md.use(sourceLinks)
      md.use(captions)
      md.use(wideTables)
    },
  },
  themeConfig: {
    logo: '/welkin.svg',
    nav: [
      { text: 'Reading order', link: '/reading_order' },
      { text: 'Glossary', link: '/glossary' },
    ],
    sidebar: sidebar(),
    outline: { level: [2, 3], label: 'On this page' },
    search: { provider: 'local' },
    docFooter: { prev: 'Previous', next: 'Next' },
  },
}
