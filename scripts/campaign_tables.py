"""What a campaign came to, as text: tables of the judge's figures by scenario and method."""
import campaign_judge as judge

FORMATS = {"avail_%": ".2f", "rms_mm": ".1f", "p95_mm": ".1f", "p99_mm": ".1f", "max_mm": ".1f", "rms_deg": ".3f",
           "max_deg": ".3f", "notice_s": ".2f", "back_s": ".2f", "nees": ".1f", "band_%": ".1f", "bend_mm": ".0f",
           "ms_p50": ".1f", "ms_p99": ".1f"}
HEALTH = ["frames", "could", "avail_%", "healthy", "false", "gross", "notice_s", "back_s", "ms_p50", "ms_p99"]
ERROR = ["rms_mm", "p95_mm", "p99_mm", "max_mm", "rms_deg", "max_deg", "nees", "band_%", "bend_mm"]


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
    if column in ("notice_s", "back_s") and value == float("inf"):
        return "never"
    return format(value, FORMATS.get(column, ""))


def table(figures, columns):
    """Header and lines: each scenario and method that has the first of the columns."""
    names = ["scenario", "method"]
    return [names + columns] + [[*(row[name] for name in names), *(cell(column, row[column]) for column in columns)]
                                for row in figures if row[columns[0]] is not None]


def render(lines):
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(text.ljust(width) if i < 2 else text.rjust(width)
                               for i, (text, width) in enumerate(zip(line, widths))) for line in lines)


def render_markdown(lines):
    rule = ["---" if i < 2 else "---:" for i in range(len(lines[0]))]
    return "\n".join("| " + " | ".join(line) + " |" for line in [lines[0], rule, *lines[1:]])


def text(figures, markdown):
    """What is printed of rows()."""
    tables = {"Health": table(figures, HEALTH), "Error of healthy frames of the map's ship": table(figures, ERROR)}
    return "\n".join(f"{title}\n\n{(render_markdown if markdown else render)(lines)}\n"
                     for title, lines in tables.items() if len(lines) > 1)
