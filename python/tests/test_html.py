"""Results as HTML for notebooks."""

import json
import re
from html.parser import HTMLParser

import pytest

import impactid
from impactid import Estimate
from impactid._estimate import decimals_for, fixed, interval_text, value_text


class Balance(HTMLParser):
    """Elements that are open; text that is shown."""

    def __init__(self):
        super().__init__()
        self.open, self.text = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def shown(html):
    parser = Balance()
    parser.feed(html)
    assert parser.open == []
    return " ".join(parser.text)


def changed(results, folder, change):
    """Results that differ from others in identification.json."""
    found = json.loads(json.dumps(results.identification))
    change(found)
    (folder / "identification.json").write_text(json.dumps(found), encoding="utf-8")
    return impactid.Results(folder)


def test_numbers_are_those_of_the_program_s_sentence(results):
    # thin spaces before units in tables, plain ones in sentences
    summary = results.summary.replace("\u2009", " ")
    for name, estimate in results.joint.items():
        assert value_text(name, estimate).replace("\u2009", " ") in summary


def test_the_answer_is_shown_with_units_and_intervals(results):
    text = shown(results._repr_html_())
    assert results.summary in text
    assert results.agreement in text
    for name, estimate in results.joint.items():
        assert value_text(name, estimate) in text
        assert interval_text(name, estimate) in text
    assert "identified" in text and "Hz" in text and "mm" in text
    assert "Trajectories" in text


def test_nothing_is_fetched_and_no_colour_is_set(results):
    html = results._repr_html_()
    assert not re.search(r"https?:|src=|href=|<script|<style|<link|color", html)


def test_what_is_not_identified_is_shown_with_its_reason(results, tmp_path):
    def change(found):
        found["joint"]["restitution"] = {
            "value": None,
            "standard_error": None,
            "interval95": None,
            "status": "not_identifiable",
            "note": {"text": "no record has impacts"},
        }
        found["verdict"]["findings"] = [{"text": "a finding"}]

    text = shown(changed(results, tmp_path, change)._repr_html_())
    assert text.count("not identifiable") == 2
    assert "no record has impacts" in text
    assert "a finding" in text


def test_text_of_the_campaign_is_escaped(results, tmp_path):
    def change(found):
        found["settings"]["name"] = "<script>a & b</script>"
        found["verdict"]["findings"] = [{"text": '<img src="x">'}]

    html = changed(results, tmp_path, change)._repr_html_()
    assert "<script" not in html and "<img" not in html and "<i>" not in html
    assert "<script>a & b</script>" in shown(html)


def test_each_specimen_has_its_own_table(results, tmp_path):
    def change(found):
        one = {name: found[name] for name in ("joint", "methods", "verdict", "agreement")}
        found["specimens"] = {"<i>steel": one, "rubber": one}

    html = changed(results, tmp_path, change)._repr_html_()
    assert html.count("95 % interval") == 2 and "<i>" not in html
    assert "<i>steel" in shown(html) and "rubber" in shown(html)


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (0.90134, 0.00241, "0.9013 ± 0.0024"),
        (0.9013, 0.00996, "0.901 ± 0.010"),
        (12.6, 2.0, "12.6 ± 2.0"),
        (1234.0, 230.0, "1234 ± 230"),
        (-0.004, 0.03, "\u22120.004 ± 0.030"),
    ],
)
def test_a_value_has_as_many_decimals_as_its_uncertainty(value, half, text):
    estimate = Estimate(value, half / 1.96, (value - half, value + half), "identified")
    assert value_text("restitution", estimate) == text


def test_a_deflection_is_shown_in_millimetres():
    estimate = Estimate(1.2345e-3, 5e-6, (1.22454e-3, 1.24446e-3), "identified")
    assert value_text("static_deflection_m", estimate) == "1.234 ± 0.010\u2009mm"
    assert interval_text("static_deflection_m", estimate) == "1.225 … 1.244\u2009mm"


def test_no_uncertainty_has_four_decimals_and_zero_no_sign():
    assert decimals_for(0.0) == 4 and decimals_for(float("nan")) == 4
    assert fixed(-0.00001, 3) == "0.000"
