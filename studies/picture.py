"""A picture of curves as SVG, for the studies: axes with units, a grid, a legend."""

from html import escape

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 20, 20, 50
COLOURS = ("#0b6e99", "#c2452d", "#3f7d20", "#7b4fa3", "#8a6d1d")


def ticks(low, high, count=5):
    """About `count` round values from low to high."""
    step = (high - low) / count
    power = 10.0 ** (len(f"{int(1e9 * step)}") - 10)
    step = min((factor * power for factor in (1.0, 2.0, 5.0, 10.0)), key=lambda each: abs(each - step))
    first = int(low / step) - 1
    return [k * step for k in range(first, first + 4 * count) if low - 1e-9 * step <= k * step <= high + 1e-9 * step]


def picture(curves, x_label, y_label):
    """The SVG text. curves: (name, x values, y values), points joined by lines; labels have their units."""
    xs = [float(x) for _, column, _ in curves for x in column]
    ys = [float(y) for _, _, column in curves for y in column]
    x_low, x_high, y_low, y_high = min(xs), max(xs), min(ys), max(ys)
    x_high += (x_high == x_low)
    y_high += (y_high == y_low)

    def at_x(x):
        return LEFT + (x - x_low) / (x_high - x_low) * (WIDTH - LEFT - RIGHT)

    def at_y(y):
        return HEIGHT - BOTTOM - (y - y_low) / (y_high - y_low) * (HEIGHT - TOP - BOTTOM)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
             'font-size="12">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for x in ticks(x_low, x_high):
        parts.append(f'<path d="M{at_x(x):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                     f'<text x="{at_x(x):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{x:g}</text>')
    for y in ticks(y_low, y_high):
        parts.append(f'<path d="M{LEFT} {at_y(y):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                     f'<text x="{LEFT - 6}" y="{at_y(y) + 4:.1f}" text-anchor="end">{y:g}</text>')
    for k, (name, column_x, column_y) in enumerate(curves):
        colour = COLOURS[k % len(COLOURS)]
        points = " ".join(f"{at_x(x):.1f},{at_y(y):.1f}" for x, y in zip(column_x, column_y))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        parts.append(f'<text x="{LEFT + 10}" y="{TOP + 16 * (k + 1)}" fill="{colour}">{escape(name)}</text>')
    parts.append(f'<text x="{WIDTH / 2}" y="{HEIGHT - 12}" text-anchor="middle">{escape(x_label)}</text>')
    parts.append(f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">{escape(y_label)}'
                 "</text></svg>")
    return "\n".join(parts) + "\n"
