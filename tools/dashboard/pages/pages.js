// Every page of the dashboard by its word in the address.
import { EventsPage } from './events_page.js';
import { InstancePage } from './instance_page.js';
import { InstancesPage } from './instances_page.js';
import { NodePage } from './node_page.js';
import { SitePage } from './site_page.js';
import { SkillsPage } from './skills_page.js';
import { TaskPage } from './task_page.js';
import { TasksPage } from './tasks_page.js';
import { TopicsPage } from './topics_page.js';
import { PlanPage } from '../planning/plan_page.js';
import { RequestsPage } from '../requests/requests_page.js';

/** A page of many things has the page of one of them behind it. */
const listOrOne = (List, One) => class {
  constructor(app, where) {
    return where.name ? new One(app, where) : new List(app, where);
  }
};

export const PAGES = {
  site: SitePage,
  nodes: listOrOne(SitePage, NodePage),
  tasks: listOrOne(TasksPage, TaskPage),
  instances: listOrOne(InstancesPage, InstancePage),
  topics: TopicsPage,
  skills: SkillsPage,
  events: EventsPage,
  plan: PlanPage,
  requests: RequestsPage,
};
