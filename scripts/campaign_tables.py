"""What a campaign came to, as text: tables of the judge's figures by scenario and method."""
import campaign_judge as judge

FORMATS = {"avail_%": ".2f", "rms_mm": ".1f", "p95_mm": ".1f", "p99_mm": ".1f", "max_mm": ".1f", "rms_deg": ".3f",
           "max_deg": ".3f", "notice_s": ".2f", "back_s": ".2f", "nees": ".1f", "band_%": ".1f", "bend_mm": ".0f",
           "ms_p50": ".1f", "ms_p99": ".1f", "no_pose_%": ".1f", "off_%": ".1f", "any_p50_m": ".3f", "any_p95_m": ".3f",
           "any_p50_deg": ".3f", "any_p95_deg": ".3f", "worst_m": ".3f", "worst_deg": ".3f", "fell_s": ".1f",
           "until_s": ".1f"}
HEALTH = ["frames", "could", "avail_%", "healthy", "false", "gross", "notice_s", "back_s", "ms_p50", "ms_p99"]
ERROR = ["rms_mm", "p95_mm", "p99_mm", "max_mm", "rms_deg", "max_deg", "nees", "band_%", "bend_mm"]
ANY_POSE = ["no_pose_%", "off_%", "any_p50_m", "any_p95_m", "any_p50_deg", "any_p95_deg"]


def rows(verdicts, scenarios, methods):
    """Figures by column: each scenario, each method; then all clear ones and all together."""
    groups = [(s["name"], [s["name"]]) for s in scenarios]
    groups += [("all clear", [s["name"] for s in scenarios if s["clear"] and s["mapped"]]),
               ("all", [s["name"] for s in scenarios])]
    found = []
    for title, names in groups:
        for method in methods:
            runs = [v for name in names for v in verdicts.get((name, method), [])]
            if runs:
                found.append({"scenario": title, "method": method, **judge.summary(judge.Verdict.join(runs))})
    return found


def cell(column, value):
    if value is None:
        return "-"
    if column in ("notice_s", "back_s", "fell_s") and value == float("inf"):
        return "never"
    return format(value, FORMATS.get(column, ""))


def cells(row, columns):
    return [cell(column, row[column]) for column in columns]


def stacked(figures, columns):
    """Header and lines: each scenario and method that has the first of the columns."""
    return [["scenario", "method", *columns]] + [[row["scenario"], row["method"], *cells(row, columns)]
                                                 for row in figures if row[columns[0]] is not None]


def side_by_side(figures, methods, columns):
    """Header ("method column") and lines: each scenario in which the ship is there, a method beside the other."""
    lines = {}
    for row in figures:
        if row["there"]:
            lines.setdefault(row["scenario"], [row["scenario"], *cells(row, ["there"])]).extend(cells(row, columns))
    header = [f"{method} {column.removeprefix('any_')}" for method in methods for column in columns]
    return [["scenario", "there", *header], *lines.values()]


def flush_left(lines):
    return [name in ("scenario", "method", "attack") for name in lines[0]]


def render(lines):
    """As text; what stands before the blank in a header goes above the first column that has it."""
    above, _, header = zip(*(name.rpartition(" ") for name in lines[0]))
    lines, left = [header, *lines[1:]], flush_left(lines)
    widths = [max(map(len, column)) for column in zip(*lines)]
    top = ""
    for i in range(1, len(widths)):
        if above[i] != above[i - 1]:
            widths[i] += 2
            top = top.ljust(sum(widths[:i]) + 2 * i + 2) + above[i]
    text = ["  ".join(word.ljust(width) if flush else word.rjust(width)
                      for word, width, flush in zip(line, widths, left)) for line in lines]
    return "\n".join([top, *text] if top else text)


def render_markdown(lines):
    rule = ["---" if left else "---:" for left in flush_left(lines)]
    return "\n".join("| " + " | ".join(line) + " |" for line in [lines[0], rule, *lines[1:]])


def text(figures, methods, markdown):
    """What is printed of rows()."""
    tables = {"Health": stacked(figures, HEALTH),
              "Error of healthy frames of the map's ship": stacked(figures, ERROR),
              "Error of every frame in which the map's ship is there, whatever health said":
                  side_by_side(figures, methods, ANY_POSE)}
    return "\n".join(f"{title}\n\n{(render_markdown if markdown else render)(lines)}\n"
                     for title, lines in tables.items() if len(lines) > 1)
