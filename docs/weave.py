#!/usr/bin/env python3
"""Weaves code, knobs and measurements into the book's Markdown, and checks that nothing in it is stale or dead.

A woven block stands between two comments; what is between them is rewritten. Paths are relative to the repository.
  <!-- weave: code FILE [region=NAME] -->          lines between `// [NAME]` and `// [/NAME]` (`#` in CMake, bash)
  <!-- weave: knobs NN -->                         table of docs/generated/knobs_NN.json
  <!-- weave: csv FILE columns=a,b=Heading where=view=noon -->  rows of a measured table; '#' lines make its caption
  <!-- weave: json FILE -->                        time of each pass in a --bench file
  <!-- weave: text FILE -->                        a text file as it is
  <!-- weave: changes 04 05 -->                    the files that chapter 05 adds, and the chapters it uses
  <!-- weave: options [FILE] -->                   table of a --help text (docs/generated/options.txt)
  <!-- /weave -->                                  closes each of them
weave.py writes; weave.py --check writes nothing. Both print one line per problem and exit 1 if there is any.
"""
import argparse, csv, json, math, operator, os, re, shlex, sys, urllib.parse
from pathlib import Path

OPEN, CLOSE = re.compile(r"<!-- weave: (.+?) -->"), "<!-- /weave -->"
FENCE = re.compile(r"\s*(`{3,}|~{3,})\s*([\w+#-]*)")
FENCED = r"^([ \t]*)(`{3,}|~{3,}).*?^[ \t]*\2[`~]*[ \t]*$"
LINK = r"\]\(\s*<?([^)\s>]+)|^\[[^\]]+\]:\s+(\S+)|\b(?:src|href)=\"([^\"]+)\""  # inline, reference, HTML
BY_HAND = {"bash", "sh", "console", "text", "toml", "math", "csv", "json"}  # fences that may be typed: no program source
LANGUAGES = {".cmake": "cmake", ".txt": "cmake", ".py": "python", ".sh": "bash", "": "bash", ".toml": "toml", ".mjs": "js"}
LANGUAGES |= dict.fromkeys((".cpp", ".hpp", ".h"), "cpp") | dict.fromkeys((".glsl", ".comp", ".vert", ".frag"), "glsl")
SOURCES = {".cpp", ".hpp", ".h", ".glsl", ".comp", ".vert", ".frag", ".cmake"}
COMPARE = {"=": operator.eq, "!=": operator.ne, "<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge}


class Problem(Exception):
    pass


def read(root, name):
    try:
        return (root / name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Problem(f"cannot read {name}: {getattr(error, 'strerror', None) or 'not UTF-8'}")


def read_json(root, name):
    try:
        return json.loads(read(root, name))
    except ValueError as error:
        raise Problem(f"{name} is not JSON: {error}")


def link(root, page, name, lines=""):
    return f"[`{name}`]({os.path.relpath(root / name, page.parent)}{lines})"


def fenced(language, lines):
    ticks = "`" * max(3, 1 + max((len(run) for run in re.findall(r"`+", "\n".join(lines))), default=0))
    return [ticks + language, *lines, ticks]


def cell(text):
    return re.sub(r"\s+", " ", str(text)).strip().replace("|", "\\|").replace("<", "&lt;").replace("{{", "{&#123;")


def number(text):
    """Four significant digits, without rounding whole numbers; any other text unchanged."""
    text = str(text)
    try:
        value = float(text)
    except ValueError:
        return cell(text)
    if not math.isfinite(value) or re.fullmatch(r"[+-]?\d+", text):
        return text
    if value == round(value) and abs(value) < 1e7 or 1e4 <= abs(value) < 1e7:
        return f"{value:.0f}"
    return re.sub(r"e([+-])0*(\d)", lambda m: "e" + m[1].strip("+") + m[2], f"{value:.4g}")


def table(headings, rows):
    numeric = re.compile(r"[+-]?[\d.]+(e-?\d+)?|nan|-?inf")
    ruler = ["---:" if all(numeric.fullmatch(row[i]) for row in rows) else "---" for i in range(len(headings))]
    return ["| " + " | ".join(row) + " |" for row in [[cell(h) for h in headings], ruler, *rows]]


def code(root, page, name, region=None):
    lines = read(root, name).rstrip("\n").split("\n")
    language = LANGUAGES.get(Path(name).suffix)
    if not language:
        raise Problem(f"{name}: no fence language is known for this kind of file")
    marks, spans = {}, {}  # region -> line of its opening marker; region -> (opening, closing)
    for i, line in enumerate(lines):
        mark = re.fullmatch(r"\s*(?://|#) \[(/?)([\w.-]+)\]\s*", line)
        if mark and not mark[1]:
            marks.setdefault(mark[2], []).append(i)
        elif mark and marks.get(mark[2]):
            spans.setdefault(mark[2], []).append((marks[mark[2]].pop(), i))
    if region and len(spans.get(region, [])) != 1:
        state = "two regions" if spans.get(region) else "an unclosed region" if region in marks else "no region"
        raise Problem(f"{name} has {state} '{region}' (it has: {', '.join(sorted(spans)) or 'none'})")
    first, last = (spans[region][0][0] + 1, spans[region][0][1]) if region else (0, len(lines))
    hidden = {line for pairs in spans.values() for pair in pairs for line in pair}
    kept = [i for i in range(first, last) if i not in hidden]
    while kept and not lines[kept[0]].strip():
        kept.pop(0)
    while kept and not lines[kept[-1]].strip():
        kept.pop()
    if not kept:
        raise Problem(f"{name}: region '{region}' is empty")
    indent = min(len(lines[i]) - len(lines[i].lstrip()) for i in kept if lines[i].strip())
    a, b = kept[0] + 1, kept[-1] + 1
    where, target = (f"line {a}", f"#L{a}") if a == b else (f"lines {a}–{b}", f"#L{a}-L{b}")
    return [*fenced(language, [lines[i][indent:].rstrip() for i in kept]), "",
            f"*{link(root, page, name, target)}, {where}*"]


def knobs(root, page, chapter):
    name = f"docs/generated/knobs_{chapter}.json"
    rows = []
    for knob in read_json(root, name)["knobs"]:
        choices = knob.get("choices") or []
        show = lambda v: f"`{choices[int(v)]}`" if choices and not isinstance(v, str) else number(v)
        span = ", ".join(f"`{c}`" for c in choices) or f"{number(knob['minimum'])} … {number(knob['maximum'])}"
        ladder = " → ".join(show(v) for v in knob.get("ladder") or []) or "–"
        name_unit = [f"`{knob['name']}`", cell(knob.get("unit") or "–")]
        rows.append([*name_unit, span, show(knob["initial"]), ladder, cell(knob["meaning"])])
    if not rows:
        raise Problem(f"{name} declares no knob")
    return table(["knob", "unit", "accepted", "default", "ladder, cheap → converged", "meaning"], rows)


def same_kind(*texts):
    try:
        return [float(text) for text in texts]
    except ValueError:
        return texts


def csv_table(root, page, name, columns=None, where=()):
    text = read(root, name).splitlines()
    notes = [line.lstrip("# ").strip() for line in text if line.startswith("#")]
    rows = list(csv.DictReader(line for line in text if line.strip() and not line.startswith("#")))
    have = list(rows[0]) if rows else []
    wanted = [(c.split("=", 1) * 2)[:2] for c in columns.split(",")] if columns else [(c, c) for c in have]
    tests = [re.fullmatch(r"([\w.:]+)(<=|>=|!=|=|<|>)(.*)", test) for test in where]
    for column in [c for c, _ in wanted] + [t[1] if t else "where= takes COLUMN=VALUE" for t in tests]:
        if column not in have:
            raise Problem(f"{name} has no column '{column}' (it has: {', '.join(have) or 'no rows'})")
    rows = [row for row in rows if all(COMPARE[t[2]](*same_kind(row[t[1]], t[3])) for t in tests)]
    if not rows:
        raise Problem(f"{name} has no row where {' and '.join(where)}")
    known = [n for n in notes if re.match(r"(device|driver|software|resolution|scene|reference|source)\b", n, re.I)]
    named = {n.split(":")[0] for n in notes}
    if any("_ms" in c for c, _ in wanted) and not {"device", "driver", "resolution"} <= named:
        raise Problem(f"{name} shows times but its '#' lines do not name device, driver and resolution")
    known = [re.sub(r"^software.*: yes$", "software driver", n) for n in known if n != "software driver: no"]
    caption = [f"*{cell(' · '.join(known or notes))}*", ""] if notes else []
    cells = [[number(row[c]) for c, _ in wanted] for row in rows]
    return [*table([heading for _, heading in wanted], cells), "", *caption][:-1]


def bench(root, page, name):
    data = read_json(root, name)
    try:
        timed = [*data["passes"], {"name": "wall clock, whole frame", **data["wall_ms"]}]
        rows = [[cell(t["name"]), *(number(t[key]) for key in ("median_ms", "min_ms", "max_ms"))] for t in timed]
        shown = f"chapter {data['chapter']}, scene {data['scene']}, view {data['view']}, {data['width']}×{data['height']}"
        label = ["software driver: says nothing about a GPU"] if data["software"] else []
        caption = " · ".join([shown, data["device"], data["driver"], *label])
    except KeyError as error:
        raise Problem(f"{name} lacks {error}")
    return [*table(["pass", "median ms", "min ms", "max ms"], rows), "", f"*{cell(caption)}*"]


def text_block(root, page, name):
    return fenced("text", [line.rstrip() for line in read(root, name).rstrip("\n").split("\n")])


def chapter_files(root, chapter):
    found = [p for top in ("chapters", "shaders") for p in sorted((root / top).glob(f"{chapter}_*/**/*")) if p.is_file()]
    return [p for p in found if p.suffix in SOURCES or p.name == "CMakeLists.txt"]


def purpose(path, text):
    """The first sentence of the file's opening comment."""
    mark = r"#(?!!) ?" if path.suffix in (".cmake", ".txt") else r"(?://+|/?\*+) ?"
    comment = []
    for line in text.split("\n"):
        match = re.match(rf"\s*{mark}(.*)", line)
        if match and match[1].strip(" */"):
            comment.append(match[1].strip(" */"))
        elif comment:
            break
    return re.split(r"(?<=[.])\s", " ".join(comment) + " ")[0].strip() or "–"


def changes(root, page, before, chapter):
    files = [(p, p.read_text(encoding="utf-8")) for p in chapter_files(root, chapter)]
    if not files:
        raise Problem(f"no file of chapter {chapter} in chapters/{chapter}_* or shaders/{chapter}_*")
    lists = [*root.glob(f"chapters/{chapter}_*/CMakeLists.txt"), root / "chapters/CMakeLists.txt", root / "CMakeLists.txt"]
    cmake = "\n".join(p.read_text(encoding="utf-8") for p in lists if p.is_file())
    call = re.search(rf"welkin_chapter\s*\(([^)]*\bNUMBER\s+{chapter}\b[^)]*)\)", cmake)
    if call is None:
        raise Problem(f"no welkin_chapter(NUMBER {chapter} …) in a CMakeLists.txt of the repository or of the chapters")
    uses = re.search(r"\bUSES\s+([a-z0-9_\s]+)", call[1])
    used = ", ".join(f"`{n}`" for n in uses[1].split()) if uses else "no other chapter"
    count = lambda text: len(text.splitlines())
    plural = lambda n, what: f"{n} {what}{'' if n == 1 else 's'}"
    earlier = [count(p.read_text(encoding="utf-8")) for p in chapter_files(root, before)]
    beside = f"Chapter {before} has {plural(len(earlier), 'file')}, {plural(sum(earlier), 'line')}. " if earlier else ""
    rows = [[link(root, page, str(p.relative_to(root))), str(count(text)), cell(purpose(p, text))] for p, text in files]
    total = sum(count(text) for _, text in files)
    return [f"{beside}Chapter {chapter} adds {plural(len(files), 'file')}, {plural(total, 'line')}; it uses {used}.", "",
            *table(["file", "lines", "what it is for"], rows)]


def options(root, page, name="docs/generated/options.txt"):
    rows, group = [], ""
    for line in read(root, name).splitlines():
        option = re.match(r"(\s{1,8})(-{1,2}\w.*?)(?:\s{2,}(.*))?$", line)
        if option:
            rows.append([cell(group), "`" + option[2].strip().replace("|", "\\|") + "`", option[3] or ""])
        elif re.match(r"\s{9,}\S", line) and rows:
            rows[-1][2] += " " + line.strip()
        elif line and not line[0].isspace():
            group = line.strip(" []:").removeprefix("Option Group: ").lower()
    if not rows:
        raise Problem(f"{name} lists no option")
    return table(["group", "option", "meaning"], [[g, o, cell(m)] for g, o, m in rows])


KINDS = {"code": code, "knobs": knobs, "csv": csv_table, "json": bench, "text": text_block, "changes": changes,
         "options": options}


def make(root, page, command):
    try:
        kind, *words = shlex.split(command)
        given = [w for w in words if not re.match(r"(region|columns|where)=", w)]
        named = dict(w.split("=", 1) for w in words if re.match(r"(region|columns)=", w))
        where = [w[6:] for w in words if w.startswith("where=")]
        block = KINDS[kind](root, page, *given, **named, **({"where": where} if where else {}))
    except KeyError as error:
        raise Problem(f"unknown kind of block or missing field {error} (kinds: {', '.join(KINDS)})")
    except (TypeError, ValueError, IndexError, AttributeError) as error:
        raise Problem(f"cannot weave '{command}': {error}")
    if any(line == CLOSE or OPEN.fullmatch(line) for line in block):
        raise Problem(f"'{command}' would bring in a weave marker")
    return ["", *block, ""]


def weave(root, page):
    """Returns the page's text as it should be, its problems and its stale blocks, both as (line, message)."""
    old, new, problems, stale, fence, i = page.read_text(encoding="utf-8").split("\n"), [], [], [], None, 0
    while i < len(old):
        line, found, opened = old[i], OPEN.fullmatch(old[i]), FENCE.match(old[i])
        if fence:
            if opened and line.strip().startswith(fence[0]) and not line.strip().strip(fence[0][0]):
                fence = None
        elif opened:
            fence = (opened[1], i + 1)
            if opened[2] not in BY_HAND and page.is_relative_to(root / "docs"):
                problems.append((i + 1, f"fence '{opened[2]}' pasted by hand: weave it from a source file"
                                        f" (only {', '.join(sorted(BY_HAND))} may be typed)"))
        elif found:
            end = next((j for j in range(i + 1, len(old)) if old[j] == CLOSE or OPEN.fullmatch(old[j])), i)
            if old[end] != CLOSE:
                problems.append((i + 1, f"weave block '{found[1]}' is not closed"))
            else:
                block = old[i + 1:end]
                try:
                    block = make(root, page, found[1])
                except Problem as problem:
                    problems.append((i + 1, str(problem)))
                if block != old[i + 1:end]:
                    stale.append((i + 1, f"stale block '{found[1]}': run docs/weave.py"))
                new += [line, *block]
                line, i = CLOSE, end
        elif re.search(r"<!--\s*/?\s*weave", line):
            problems.append((i + 1, f"malformed or unmatched weave marker: {line.strip()}"))
        new.append(line)
        i += 1
    if fence:
        problems.append((fence[1], "code fence is not closed"))
    return "\n".join(new), problems, stale


def prose(text):
    """The text with fences, comments, code spans and formulas blanked out, line for line."""
    for pattern in (FENCED, r"<!--.*?-->", r"(`+)[^\n]*?[^`\n]\1(?!`)", r"\$\$.*?\$\$", r"\$[^$\n]+\$"):
        text = re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.M | re.S)
    return text


def anchors(text):
    """The anchors of a page's headings as GitHub and the site make them, and explicit ids."""
    found = set(re.findall(r"\bid=\"([^\"]+)\"", text))
    bare = re.sub(FENCED, "", text, flags=re.M | re.S)
    for heading in re.findall(r"^#{1,6} +(.*?)[ #]*$", bare, re.M):
        slug = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)|<[^>]*>", "", heading).lower()).replace(" ", "-")
        found.add(next(s for s in [slug, *(f"{slug}-{n}" for n in range(1, 999))] if s not in found))
    return found


def dead_links(root, page, text, texts):
    for match in re.finditer(LINK, prose(text), re.M):
        url = match[1] or match[2] or match[3]
        line = text.count("\n", 0, match.start()) + 1
        name, _, anchor = urllib.parse.unquote(url).partition("#")
        target = Path(os.path.normpath(page.parent / name)) if name else page
        figure = target.suffix.lower() in (".png", ".svg", ".jpg", ".webp", ".gif")
        if re.match(r"(https?|mailto):", url):
            continue
        if name.startswith("/") or not target.is_relative_to(root):
            yield line, f"link {url} must be relative and stay in the repository"
        elif not target.exists():
            yield line, f"{'missing figure' if figure else 'dead link'} {url}"
        elif anchor and target.suffix == ".md" and anchor not in anchors(texts.get(target) or read(root, target)):
            yield line, f"dead anchor {url}"


def main():
    parser = argparse.ArgumentParser(description="weave the book (see the top of this file)")
    parser.add_argument("--check", action="store_true", help="write nothing; a stale block is a problem")
    parser.add_argument("--root", type=Path, default=Path(__file__).parent.parent, help="the repository")
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    pages = [p for p in sorted((root / "docs").rglob("*.md")) if not {"node_modules", ".vitepress"} & set(p.parts)]
    pages += [p for p in (root / "README.md", root / "CONTRIBUTING.md") if p.is_file()]
    woven = {page: weave(root, page) for page in pages}
    texts = {page: text for page, (text, _, _) in woven.items()}
    problems = 0
    for page, (text, found, stale) in woven.items():
        if stale and not arguments.check:
            temporary = page.with_name(f".{page.name}.{os.getpid()}")
            temporary.write_text(text, encoding="utf-8")
            os.replace(temporary, page)
            print(f"wove {page.relative_to(root)}")
        found += [*(stale if arguments.check else []), *dead_links(root, page, text, texts)]
        for line, message in sorted(found):
            print(f"{page.relative_to(root)}:{line}: {message}", file=sys.stderr)
            problems += 1
    print(f"{len(pages)} pages, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
