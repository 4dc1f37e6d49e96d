#!/usr/bin/python3
"""Links of the documents lead to files and headings that are there, and what they say of calibrations holds."""
import collections
import functools
import json
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [path for pattern in ("*.md", "docs/*.md", "models/*.md", "schema/*.md") for path in ROOT.glob(pattern)]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


@functools.cache
def anchors(document):
    """Of its headings, as GitHub makes them."""
    seen = collections.Counter()
    result = set()
    for heading in re.findall(r"^#+ +(.*)$", without_code(document.read_text(encoding="utf-8")), re.MULTILINE):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        anchor = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        result.add(f"{anchor}-{seen[anchor]}" if seen[anchor] else anchor)
        seen[anchor] += 1
    return result


class Links(unittest.TestCase):
    def test_lead_to_files_and_headings_that_are_there(self):
        links = 0
        for document in DOCUMENTS:
            for target in LINK.findall(without_code(document.read_text(encoding="utf-8"))):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (document.parent / path).resolve() if path else document
                with self.subTest(document=document.relative_to(ROOT), target=target):
                    self.assertTrue(file.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(file))
                links += 1
        self.assertGreater(links, 80)


def maps_of(manifest):
    """What each map of a bench manifest is made from, by its name."""
    maps = json.loads((ROOT / "docs" / "calibration" / manifest).read_text(encoding="utf-8"))["maps"]
    return {each["name"]: json.dumps(each["sources"], sort_keys=True) for each in maps}


class Calibration(unittest.TestCase):
    def test_is_checked_on_none_of_the_maps_that_it_was_learned_from(self):
        origin = json.loads((ROOT / "schema" / "calibration.json").read_text(encoding="utf-8"))["origin"]
        learned = maps_of(origin["manifest"])
        self.assertEqual(sorted(learned), sorted(origin["maps"]))
        for manifest in ("check.bench.json", "cities.bench.json", "degrade.bench.json", "rendered.bench.json"):
            self.assertEqual(set(maps_of(manifest).values()) & set(learned.values()), set(), manifest)
        headings = maps_of(origin["heading"]["manifest"])
        for manifest in ("check.bench.json", "rendered.bench.json"):
            self.assertEqual(set(maps_of(manifest).values()) & set(headings.values()), set(), manifest)


if __name__ == "__main__":
    unittest.main()
