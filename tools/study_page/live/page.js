"use strict";

const find = id => document.getElementById(id);

function make(tag, properties, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
}

let experiments = [];
let last = null;  // the answer that is shown as this picture

const chosen = () => experiments[find("experiment").selectedIndex];
const input = control => find("control-" + control.name);

function valueOf(control) {
    return control.stops ? control.stops[Number(input(control).value)] : input(control).value;
}

const textOf = control => control.stops ? String(valueOf(control)) : input(control).selectedOptions[0].textContent;

function makeInput(control) {
    const id = "control-" + control.name;
    if (!control.stops) {
        return [make("select", {id}, ...control.values.map(
            ([value, textContent]) => make("option", {value, textContent, selected: value === control.start})))];
    }
    return [make("input", {id, type: "range", min: 0, max: control.stops.length - 1, value: control.stops.indexOf(control.start)}),
            make("output", {id: id + "-value", htmlFor: id})];
}

// Says the sliders' values, and leaves out what has no effect.
function follow() {
    for (const control of chosen().controls) {
        if (control.stops) {
            find("control-" + control.name + "-value").value = textOf(control);
            input(control).setAttribute("aria-valuetext", textOf(control));
        }
        input(control).disabled = !Object.entries(control.onlyWith).every(
            ([name, values]) => values.includes(find("control-" + name).value));
    }
}

function showExperiment() {
    find("about").textContent = chosen().about;
    find("controls").replaceChildren(...chosen().controls.map(control => make(
        "div", {}, make("label", {htmlFor: "control-" + control.name, textContent: control.label}), ...makeInput(control))));
    follow();
}

function say(text, isWrong = false) {
    find("status").textContent = text;
    find("status").classList.toggle("wrong", isWrong);
}

function showPicture(section, answer) {
    section.replaceChildren(
        section.querySelector("h2"), make("img", {src: answer.image, alt: answer.name}), make("p", {textContent: answer.name}),
        make("dl", {}, ...answer.facts.flatMap(([what, value]) => [make("dt", {textContent: what}), make("dd", {textContent: value})])),
        make("p", {}, make("code", {textContent: answer.command})));
}

function nameRequest() {
    const settings = chosen().controls.filter(control => !input(control).disabled);
    return chosen().title + ": " + settings.map(control => control.label.toLowerCase() + " " + textOf(control)).join(", ");
}

async function render(event) {
    event.preventDefault();
    const request = {experiment: chosen().key}, name = nameRequest();
    for (const control of chosen().controls) {
        request[control.name] = valueOf(control);
    }
    find("render").disabled = true;
    say("Rendering");
    try {
        const response = await fetch("render", {method: "POST", body: JSON.stringify(request)});
        const answer = await response.json();
        if (!response.ok) {
            say("Not rendered: " + answer.error, true);
            return;
        }
        answer.name = name;
        if (last) {
            showPicture(find("before"), last);
        }
        showPicture(find("now"), answer);
        say("Rendered" + (last && last.digest === answer.digest ? ": bit for bit the picture before" : ""));
        last = answer;
    } catch {
        say("Nobody answers: start tools/study --serve again, and open the address that it prints", true);
    } finally {
        find("render").disabled = false;
    }
}

async function begin() {
    const told = await (await fetch("experiments.json")).json();
    experiments = told.experiments;
    find("device").textContent = told.glim + " on " + told.device + ".";
    find("experiment").append(...experiments.map(({key, title}) => make("option", {value: key, textContent: title})));
    find("experiment").value = "direct";
    find("experiment").addEventListener("change", showExperiment);
    find("controls").addEventListener("input", follow);
    find("form").addEventListener("submit", render);
    showExperiment();
    find("render").disabled = false;
}

begin();
