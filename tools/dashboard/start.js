// The page's only entry. A part that does not come, because the node is being
// restarted, must not leave a page that waits for ever.
const AGAIN_MS = 3000;

/** Named here so that they come together and not one after the other. */
const PARTS = {
  cell: 'api event_stream metrics flights follow_events questions samples store',
  graph: 'graph_layout graph_picture',
  json: 'json_box json_places',
  page: 'announcer dom frame frames help marks router shortcuts table theme words',
  planning: 'decision_view drafts drag field keep_place parameter_field plan_page plan_tables plan_view step_form '
    + 'stream_fields task_copy task_document task_form what_if',
  requests: 'catalogue refusal_view request_form requests_page sender',
  pages: 'columns event_rows events_page instance_page instances_page log_follower log_view node_page '
    + 'pages search_field site_page skills_page task_page tasks_page topics_page',
};

for (const [folder, names] of Object.entries(PARTS))
  for (const name of names.split(' '))
    document.head.append(Object.assign(document.createElement('link'), { rel: 'modulepreload', href: `${folder}/${name}.js` }));

import('./main.js').catch((problem) => {
  console.error(problem);
  document.getElementById('page').textContent = 'A part of the page did not come. Loading it again …';
  setTimeout(() => location.reload(), AGAIN_MS);
});
