// Every room of the page by its word in the address.
import { EventsRoom } from './events_room.js';
import { InstanceRoom } from './instance_room.js';
import { InstancesRoom } from './instances_room.js';
import { NodeRoom } from './node_room.js';
import { SiteRoom } from './site_room.js';
import { TaskRoom } from './task_room.js';
import { TasksRoom } from './tasks_room.js';
import { TopicsRoom } from './topics_room.js';
import { PlanRoom } from '../planning/plan_room.js';
import { RequestsRoom } from '../requests/requests_room.js';

/** A room of many things has the room of one of them behind it. */
const listOrOne = (List, One) => class {
  constructor(app, where) {
    return where.name ? new One(app, where) : new List(app, where);
  }
};

export const ROOMS = {
  site: SiteRoom,
  nodes: listOrOne(SiteRoom, NodeRoom),
  tasks: listOrOne(TasksRoom, TaskRoom),
  instances: listOrOne(InstancesRoom, InstanceRoom),
  topics: TopicsRoom,
  events: EventsRoom,
  plan: PlanRoom,
  requests: RequestsRoom,
};
