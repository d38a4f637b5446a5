"""Tables of numbers as text, for terminals and documents."""


def text_table(header, rows, ragged=1):
    """Lines of text under a rule. Each column is as wide as its cells, but for the last `ragged` ones, which are long."""
    lines = [header, *rows]
    widths = [max(len(row[k]) for row in lines) for k in range(len(header) - ragged)] + [0] * ragged
    text = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in lines]
    return "\n".join([text[0], "-" * len(text[0]), *text[1:]])


def markdown_table(header, rows):
    text = ["| " + " | ".join(header) + " |", "| --- " * len(header) + "|"]
    return "\n".join(text + ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows])
