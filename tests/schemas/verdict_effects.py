"""The part of docs/schemas/verdict-1.json that names effects, from the table of docs/effects.md.

That table comes from the descriptors of the effects, so that an effect is written once. A test compares the file with
what this makes of it, and writes the file as it must be where they differ.
"""

import json
import re

WIDTH = 118  # of a line of the file

ROW = re.compile(r"\| \[(\w+)\]\([^)]*\) \| (.*?) \| (.*) \|$", re.M)
KEY = re.compile(r"`(\w+)`( \[\.\.\])?(?: \(([^)]*)\))?")


def suffix(unit):
    """A unit behind a key: "N s/m" is _N_s_per_m."""
    if not unit:
        return ""
    return re.sub(r"^_1_", "_", "_" + unit.replace("^", "").replace("/", "_per_").replace(" ", "_"))


def units(unit):
    """The unit, and the one that it has with a motor that is driven by voltage."""
    return [unit] + ([unit.replace("A", "V")] if "A" in unit and "V" not in unit else [])


# With angles in place of lengths.
ROTARY = {"m": "rad", "m/s": "rad/s", "m/s^2": "rad/s^2", "N": "N m", "N/m": "N m/rad", "N s/m": "N m s/rad",
          "kg": "kg m^2", "N/A": "N m/A", "N/V": "N m/V", "A s/m": "A s/rad", "V s/m": "V s/rad"}


def spelled(unit):
    """Every unit that a key may have, each with the axes that have it."""
    for each in units(unit):
        of = ", of a motor that is driven by voltage" if each != unit else ""
        yield each, of
        if each in ROTARY:
            yield ROTARY[each], ", of a rotary axis" + of.replace(", of", " and")


def parameters(keys):
    """The schema of an effect's parameters."""
    properties = {}
    for key, is_list, unit in KEY.findall(keys):
        for each, of in spelled(unit):
            text = f"key `{key}`" + (f", in {each}" if each else ", without unit") + of
            kind = {"$ref": "#/$defs/number_list"} if is_list else {"type": "number"}
            properties[key + suffix(each)] = {**kind, "description": text}
    return {"type": "object", "additionalProperties": False, "properties": properties}


def with_effects(schema, page):
    """`schema` with the effects of `page` in place of those that it has."""
    rows = ROW.findall(page)
    names = [name for name, _, _ in rows]
    parts = dict(schema["$defs"])
    for old in parts["effect"]["enum"]:
        parts.pop(old, None)
    parts["effect"] = {"enum": names}
    parts["finding"] = {**parts["finding"], "allOf": [
        {"if": {"properties": {"effect": {"const": name}}},
         "then": {"properties": {"parameters": {"$ref": f"#/$defs/{name}"}, "standard_errors": {"$ref": f"#/$defs/{name}"}}}}
        for name in names]}
    for name, meaning, keys in rows:
        parts[name] = {"description": meaning, **parameters(keys)}
    return {**schema, "$defs": parts}


def formatted(value, indent=0, lead=""):
    """JSON with what fits on a line on one line, as the files have it."""
    flat = json.dumps(value, ensure_ascii=False)
    if indent and (not isinstance(value, (dict, list)) or not value or indent + len(lead) + len(flat) + 1 <= WIDTH):
        return " " * indent + lead + flat
    pad = " " * indent
    if isinstance(value, dict):
        items = [formatted(part, indent + 2, f"{json.dumps(key, ensure_ascii=False)}: ") for key, part in value.items()]
        return f"{pad}{lead}{{\n" + ",\n".join(items) + f"\n{pad}}}"
    return f"{pad}{lead}[\n" + ",\n".join(formatted(part, indent + 2) for part in value) + f"\n{pad}]"
