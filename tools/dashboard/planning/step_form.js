// The form of one step, made from its skill's descriptor.
import { button, el } from '../page/dom.js';
import { warning } from '../page/marks.js';
import { labelWords } from '../page/words.js';
import { choice, field, setOrDrop, textInput } from './field.js';
import { parameterField } from './parameter_field.js';
import { streamFields } from './stream_fields.js';
import { labelsOf } from './task_document.js';

/** `skills` are descriptors; `redo` makes the whole form again. */
export function stepForm({ step, index, pipeline, skills, onChange, redo }) {
  const where = `/pipeline/${index}`;
  const ofOperation = skills.filter((x) => x.operation === step.operation);
  const models = ofOperation.flatMap((x) => x.models);
  const model = models.find((x) => x.name === step.model);
  const descriptor = ofOperation.find((x) => x.models.includes(model)) ?? ofOperation[0];
  const shape = { where, onChange, redo };
  return el('section', { class: 'step-form', 'aria-label': `Step ${step.id}` },
    el('header', {}, el('h3', {}, `Step ${index + 1}`),
      button('Remove', (event) => leave(event.target, pipeline, index, redo), { class: 'quiet remove', 'aria-label': `Remove step ${step.id}` })),
    whatFields(step, models, model, skills, shape),
    descriptor ? streams(step, descriptor, pipeline, shape)
      : warning('No node of the cell has this skill; the JSON can be changed all the same.'),
    model ? parameters(step, model, shape) : null, lifeFields(step, shape));
}

/** Who used the button of what goes is then at the one that brings another. */
function leave(button, pipeline, index, redo) {
  button.closest('form').querySelector('.adder button').focus();
  button.closest('.step-form').remove();
  pipeline.splice(index, 1);
  redo();
}

function whatFields(step, models, model, skills, { where, onChange, redo }) {
  const operations = [...new Set(skills.map((x) => x.operation))].sort();
  const withOwn = (words, own) => (own && !words.includes(own) ? [...words, own] : words);
  const deployments = model?.deployments.map((x) => x.name) ?? [];
  return el('div', { class: 'row' },
    field(`${where}/id`, 'Id', textInput(step.id ?? '', (text) => { step.id = text; onChange(); })),
    field(`${where}/operation`, 'Operation', choice(withOwn(operations, step.operation), step.operation, (value) => {
      step.operation = value;
      step.model = skills.find((x) => x.operation === value).models[0].name;
      delete step.deployment;
      delete step.parameters;
      redo();
    })),
    field(`${where}/model`, 'Model', choice(withOwn([...new Set(models.map((x) => x.name))], step.model), step.model, (value) => {
      step.model = value;
      delete step.deployment;
      redo();
    })),
    field(`${where}/deployment`, 'Deployment', choice([['', 'any that fits'], ...withOwn(deployments, step.deployment)], step.deployment ?? '', (value) => {
      setOrDrop(step, 'deployment', value);
      onChange();
    })));
}

function streams(step, descriptor, pipeline, { where, onChange, redo }) {
  const others = pipeline.filter((x) => x !== step);
  return ['input', 'output'].map((side) => streamFields({ step, side, port: descriptor[side], others, where, onChange, onShape: redo }));
}

function parameters(step, model, { where, onChange }) {
  const declared = Object.entries(model.parameters ?? {});
  if (declared.length === 0)
    return null;
  const set = Object.keys(step.parameters ?? {}).length;
  return el('details', { class: 'parameters', open: declared.length <= 4 || set > 0 },
    el('summary', {}, `Parameters (${declared.length}${set ? `, ${set} set` : ''})`),
    el('div', { class: 'row' }, declared.map(([name, value]) => parameterField(step, name, value, where, onChange))));
}

function lifeFields(step, { where, onChange }) {
  const set = (name) => (value) => {
    setOrDrop(step, name, value);
    onChange();
  };
  const policy = (name) => (value) => set(name)(value === '' ? undefined : { ...step[name], policy: value });
  const whole = (name) => (text) => set(name)(text === '' ? undefined : Number(text));
  const some = ['labels', 'restart', 'on_node_loss', 'priority', 'safe_timeout_s'].some((x) => step[x] !== undefined);
  return el('details', { class: 'life', open: some }, el('summary', {}, 'Where, and how it lives'), el('div', { class: 'row' },
    field(`${where}/labels`, 'On a node labelled', textInput(labelWords(step.labels), (text) => {
      const labels = labelsOf(text);
      set('labels')(Object.keys(labels).length ? labels : undefined);
    }, { placeholder: 'room=lab' })),
    field(`${where}/restart`, 'Restart', choice([['', 'as the skill has it'], 'on_failure', 'always', 'never'], step.restart?.policy ?? '', policy('restart'))),
    field(`${where}/on_node_loss`, 'If its node is lost', choice([['', 'as the skill has it'], 'wait', 'move'], step.on_node_loss?.policy ?? '', policy('on_node_loss'))),
    field(`${where}/priority`, 'Priority (0 to 9)', textInput(step.priority ?? '', whole('priority'), { type: 'number', min: 0, max: 9 })),
    field(`${where}/safe_timeout_s`, 'Waits to be stop-safe (s)', textInput(step.safe_timeout_s ?? '', whole('safe_timeout_s'), { type: 'number', min: 0, placeholder: '0: for ever' }))));
}
